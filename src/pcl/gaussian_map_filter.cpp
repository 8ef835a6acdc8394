// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/gaussian_map_filter.h"

namespace gaussmap {

template class GaussianMapFilter<pcl::PointXYZ>;
template class GaussianMapFilter<pcl::PointXYZI>;
template class GaussianMapFilter<pcl::PointXYZRGB>;
template class GaussianMapFilter<pcl::PointNormal>;
template class GaussianMapFilter<pcl::PointXYZINormal>;

}  // namespace gaussmap
