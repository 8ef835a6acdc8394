// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/registration.h"

#include <Eigen/Geometry>
#include <sstream>
#include <stdexcept>

#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"

namespace gaussmap {
namespace {

constexpr double kRigid = 1e-3;  // tolerance for rotations that were rounded to floats or read from text files

}  // namespace

GaussianMapOctree buildTargetMap(const std::vector<Eigen::Vector3d>& points,
                                 const GaussianMapRegistrationOptions& options) {
  RefineOptions refinement;
  refinement.threads = options.registration.threads;
  return refine<3>(build<3>(points, options.map), PerCell{options.budget}, refinement).map;
}

Pose poseOfMatrix(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const bool rigid = matrix.allFinite() &&
                     (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRigid &&
                     rotation.determinant() > 0.0 && matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), kRigid);
  if (!rigid) {
    std::ostringstream text;
    text << "the matrix is not a rigid transform:\n" << matrix;
    throw std::invalid_argument(text.str());
  }
  return normalised({matrix.topRightCorner<3, 1>(), Pose::Rotation(rotation)});
}

Eigen::Matrix4d matrixOf(const Pose& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.translation;
  return matrix;
}

template class GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ>;
template class GaussianMapRegistration<pcl::PointXYZI, pcl::PointXYZI>;
template class GaussianMapRegistration<pcl::PointXYZRGB, pcl::PointXYZRGB>;
template class GaussianMapRegistration<pcl::PointNormal, pcl::PointNormal>;
template class GaussianMapRegistration<pcl::PointXYZINormal, pcl::PointXYZINormal>;

}  // namespace gaussmap
