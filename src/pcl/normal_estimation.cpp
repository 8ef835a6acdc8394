// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/normal_estimation.h"

namespace gaussmap {

template class CellNormalEstimation<pcl::PointXYZ, pcl::Normal>;
template class CellNormalEstimation<pcl::PointXYZI, pcl::Normal>;
template class CellNormalEstimation<pcl::PointXYZRGB, pcl::Normal>;
template class CellNormalEstimation<pcl::PointNormal, pcl::Normal>;
template class CellNormalEstimation<pcl::PointXYZINormal, pcl::Normal>;

}  // namespace gaussmap
