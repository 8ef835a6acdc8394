// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/normal_estimation.h"

namespace gaussmap {

template class GaussianMapNormalEstimation<pcl::PointXYZ, pcl::Normal>;
template class GaussianMapNormalEstimation<pcl::PointXYZI, pcl::Normal>;
template class GaussianMapNormalEstimation<pcl::PointXYZRGB, pcl::Normal>;
template class GaussianMapNormalEstimation<pcl::PointNormal, pcl::Normal>;
template class GaussianMapNormalEstimation<pcl::PointXYZINormal, pcl::Normal>;

}  // namespace gaussmap
