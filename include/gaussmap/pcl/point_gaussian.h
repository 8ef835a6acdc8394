// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <pcl/memory.h>
#include <pcl/pcl_macros.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdint>

namespace gaussmap {

// PCL's macro for x y z makes an anonymous struct in a union, which is not standard C++.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"

/// One Gaussian of a map as a PCL point. x y z is the mean, so any PCL tool can show and filter the cloud. The fields
/// are those of the PCD files of savePcd(). The PCL libraries do not contain PCL's templates, such as pcl::PassThrough,
/// for this type. To use them with it, define PCL_NO_PRECOMPILE before the first PCL header.
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

}  // namespace gaussmap

POINT_CLOUD_REGISTER_POINT_STRUCT(
    gaussmap::PointGaussian,
    (float, x, x)(float, y, y)(float, z, z)(float[6], covariance,
                                            covariance)(float, weight, weight)(float, occupancy,
                                                                               occupancy)(float, cell_side, cell_side)(
        float, scale, scale)(std::int32_t, cell_x, cell_x)(std::int32_t, cell_y, cell_y)(std::int32_t, cell_z, cell_z))
