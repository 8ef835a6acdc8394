// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/memory.h>
#include <pcl/pcl_macros.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <Eigen/Core>
#include <cstdint>
#include <iosfwd>

#include "gaussmap/version.h"

namespace gaussmap {

// PCL's macro for x y z makes an anonymous struct in a union, which is not standard C++.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"

/// One Gaussian of a map as a PCL point. x y z is the mean, so any PCL tool can show and filter the cloud. The fields
/// are those of the PCD files of savePcd(). The library gaussmap::pcl instantiates the common class templates of PCL
/// for this type: the search classes, the octrees, and most filters (docs/pcl.md lists them). For other templates of
/// PCL, define PCL_NO_PRECOMPILE before the first PCL header, as for any point type of your own.
struct EIGEN_ALIGN16 PointGaussian {
  PCL_ADD_POINT4D;      ///< mean [m]
  float covariance[6];  ///< xx xy xz yy yz zz [m^2]
  float weight;         ///< number of points
  float occupancy;      ///< log-odds; 10 everywhere in a map without occupancy
  float cell_side;      ///< side of its cell [m]
  float scale;          ///< 0 = finest; a float because pcl::PassThrough filters only floats
  std::int32_t cell_x,  ///< key of its cell, x
      cell_y,           ///< key of its cell, y
      cell_z;           ///< key of its cell, z
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

#pragma GCC diagnostic pop

/// Writes the fields of a point in one line, as PCL does for its own point types.
GAUSSMAP_API std::ostream& operator<<(std::ostream& out, const PointGaussian& point);

namespace detail {

/// Transforms the Gaussians of a cloud in place. See transformPointCloud().
GAUSSMAP_API void transformGaussians(const Eigen::Matrix4d& transform, bool copy_all_fields,
                                     pcl::PointCloud<PointGaussian>& cloud);

}  // namespace detail
}  // namespace gaussmap

#include "gaussmap/pcl/impl/transform_gaussians.hpp"

POINT_CLOUD_REGISTER_POINT_STRUCT(
    gaussmap::PointGaussian,
    (float, x, x)(float, y, y)(float, z, z)(float[6], covariance,
                                            covariance)(float, weight, weight)(float, occupancy,
                                                                               occupancy)(float, cell_side, cell_side)(
        float, scale, scale)(std::int32_t, cell_x, cell_x)(std::int32_t, cell_y, cell_y)(std::int32_t, cell_z, cell_z))
