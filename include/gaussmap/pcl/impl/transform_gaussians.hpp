// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/PointIndices.h>
#include <pcl/point_cloud.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <type_traits>

#include "gaussmap/pcl/point_gaussian.h"

// Overloads of pcl::transformPointCloud() for clouds of Gaussians, with the same parameters as PCL's functions. Where
// PCL has a template for any Scalar and a function for floats, both are needed here too: only the function for floats
// accepts expressions, such as matrix.inverse().
namespace gaussmap {
namespace detail {

/// void if Scalar is a floating-point type. Otherwise there is no such type, which removes the overload: in
/// pcl::transformPointCloud<PointGaussian>(...), the template argument is the point type.
template <typename Scalar>
using IfFloatingPoint = std::enable_if_t<std::is_floating_point_v<Scalar>>;

}  // namespace detail

/// Transforms a cloud of Gaussians: the mean becomes A m + t, and the covariance becomes A C A^T, where A is the 3 x 3
/// part of `transform` and t is its translation.
///
/// The compiler chooses these overloads instead of PCL's templates, also for calls of pcl::transformPointCloud(). PCL's
/// templates would transform the means, but not the covariances. As with PCL, `in` and `out` can be the same cloud, and
/// sensor_origin_ and sensor_orientation_ do not change. If `copy_all_fields` is false, all fields except mean and
/// covariance are those of a new point. If it is true, they are copied, also the keys of the cells, although the
/// Gaussians no longer lie in these cells. To transform a map, use transformMap(), which sorts the Gaussians into new
/// cells.
template <typename Scalar>
detail::IfFloatingPoint<Scalar> transformPointCloud(const pcl::PointCloud<PointGaussian>& in,
                                                    pcl::PointCloud<PointGaussian>& out,
                                                    const Eigen::Matrix<Scalar, 4, 4>& transform,
                                                    bool copy_all_fields = true) {
  if (&in != &out) out = in;
  detail::transformGaussians(transform.template cast<double>(), copy_all_fields, out);
}
/// Transforms a cloud of Gaussians by a float matrix.
inline void transformPointCloud(const pcl::PointCloud<PointGaussian>& in, pcl::PointCloud<PointGaussian>& out,
                                const Eigen::Matrix4f& transform, bool copy_all_fields = true) {
  transformPointCloud<float>(in, out, transform, copy_all_fields);
}
/// Transforms a cloud of Gaussians by an affine transform.
template <typename Scalar>
detail::IfFloatingPoint<Scalar> transformPointCloud(const pcl::PointCloud<PointGaussian>& in,
                                                    pcl::PointCloud<PointGaussian>& out,
                                                    const Eigen::Transform<Scalar, 3, Eigen::Affine>& transform,
                                                    bool copy_all_fields = true) {
  transformPointCloud<Scalar>(in, out, transform.matrix(), copy_all_fields);
}
/// Transforms a cloud of Gaussians by a float affine transform.
inline void transformPointCloud(const pcl::PointCloud<PointGaussian>& in, pcl::PointCloud<PointGaussian>& out,
                                const Eigen::Affine3f& transform, bool copy_all_fields = true) {
  transformPointCloud<float>(in, out, transform.matrix(), copy_all_fields);
}
/// Transforms a cloud of Gaussians by a rotation, followed by a translation [m].
template <typename Scalar>
detail::IfFloatingPoint<Scalar> transformPointCloud(const pcl::PointCloud<PointGaussian>& in,
                                                    pcl::PointCloud<PointGaussian>& out,
                                                    const Eigen::Matrix<Scalar, 3, 1>& offset,
                                                    const Eigen::Quaternion<Scalar>& rotation,
                                                    bool copy_all_fields = true) {
  const Eigen::Transform<Scalar, 3, Eigen::Affine> transform(Eigen::Translation<Scalar, 3>(offset) * rotation);
  transformPointCloud<Scalar>(in, out, transform.matrix(), copy_all_fields);
}
/// Transforms a cloud of Gaussians by a float rotation, followed by a float translation [m].
inline void transformPointCloud(const pcl::PointCloud<PointGaussian>& in, pcl::PointCloud<PointGaussian>& out,
                                const Eigen::Vector3f& offset, const Eigen::Quaternionf& rotation,
                                bool copy_all_fields = true) {
  transformPointCloud<float>(in, out, offset, rotation, copy_all_fields);
}

/// Transforms the selected Gaussians of a cloud. `out` receives only these.
template <typename Scalar>
detail::IfFloatingPoint<Scalar> transformPointCloud(const pcl::PointCloud<PointGaussian>& in,
                                                    const pcl::Indices& indices, pcl::PointCloud<PointGaussian>& out,
                                                    const Eigen::Matrix<Scalar, 4, 4>& transform,
                                                    bool copy_all_fields = true) {
  out = pcl::PointCloud<PointGaussian>(in, indices);
  detail::transformGaussians(transform.template cast<double>(), copy_all_fields, out);
}
/// Transforms the selected Gaussians of a cloud by a float matrix.
inline void transformPointCloud(const pcl::PointCloud<PointGaussian>& in, const pcl::Indices& indices,
                                pcl::PointCloud<PointGaussian>& out, const Eigen::Matrix4f& transform,
                                bool copy_all_fields = true) {
  transformPointCloud<float>(in, indices, out, transform, copy_all_fields);
}
/// Transforms the selected Gaussians of a cloud by an affine transform.
template <typename Scalar>
detail::IfFloatingPoint<Scalar> transformPointCloud(const pcl::PointCloud<PointGaussian>& in,
                                                    const pcl::Indices& indices, pcl::PointCloud<PointGaussian>& out,
                                                    const Eigen::Transform<Scalar, 3, Eigen::Affine>& transform,
                                                    bool copy_all_fields = true) {
  transformPointCloud<Scalar>(in, indices, out, transform.matrix(), copy_all_fields);
}
/// Transforms the selected Gaussians of a cloud by a float affine transform.
inline void transformPointCloud(const pcl::PointCloud<PointGaussian>& in, const pcl::Indices& indices,
                                pcl::PointCloud<PointGaussian>& out, const Eigen::Affine3f& transform,
                                bool copy_all_fields = true) {
  transformPointCloud<float>(in, indices, out, transform.matrix(), copy_all_fields);
}
/// Transforms the selected Gaussians of a cloud.
template <typename Scalar>
detail::IfFloatingPoint<Scalar> transformPointCloud(const pcl::PointCloud<PointGaussian>& in,
                                                    const pcl::PointIndices& indices,
                                                    pcl::PointCloud<PointGaussian>& out,
                                                    const Eigen::Matrix<Scalar, 4, 4>& transform,
                                                    bool copy_all_fields = true) {
  transformPointCloud<Scalar>(in, indices.indices, out, transform, copy_all_fields);
}
/// Transforms the selected Gaussians of a cloud by a float matrix.
inline void transformPointCloud(const pcl::PointCloud<PointGaussian>& in, const pcl::PointIndices& indices,
                                pcl::PointCloud<PointGaussian>& out, const Eigen::Matrix4f& transform,
                                bool copy_all_fields = true) {
  transformPointCloud<float>(in, indices.indices, out, transform, copy_all_fields);
}
/// Transforms the selected Gaussians of a cloud by an affine transform.
template <typename Scalar>
detail::IfFloatingPoint<Scalar> transformPointCloud(const pcl::PointCloud<PointGaussian>& in,
                                                    const pcl::PointIndices& indices,
                                                    pcl::PointCloud<PointGaussian>& out,
                                                    const Eigen::Transform<Scalar, 3, Eigen::Affine>& transform,
                                                    bool copy_all_fields = true) {
  transformPointCloud<Scalar>(in, indices.indices, out, transform.matrix(), copy_all_fields);
}
/// Transforms the selected Gaussians of a cloud by a float affine transform.
inline void transformPointCloud(const pcl::PointCloud<PointGaussian>& in, const pcl::PointIndices& indices,
                                pcl::PointCloud<PointGaussian>& out, const Eigen::Affine3f& transform,
                                bool copy_all_fields = true) {
  transformPointCloud<float>(in, indices.indices, out, transform.matrix(), copy_all_fields);
}

}  // namespace gaussmap

namespace pcl {
using gaussmap::transformPointCloud;  // for calls as pcl::transformPointCloud()
}  // namespace pcl
