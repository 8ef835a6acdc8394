// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/dynamic_points_filter.h"

namespace gaussmap {

template class DynamicPointsFilter<pcl::PointXYZ>;
template class DynamicPointsFilter<pcl::PointXYZI>;
template class DynamicPointsFilter<pcl::PointXYZRGB>;
template class DynamicPointsFilter<pcl::PointNormal>;
template class DynamicPointsFilter<pcl::PointXYZINormal>;

}  // namespace gaussmap
