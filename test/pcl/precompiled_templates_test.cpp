// SPDX-License-Identifier: BSD-3-Clause
// A user of PCL's own point types links PCL's compiled templates, whatever headers of gaussmap come first.
#include "gaussmap/pcl/conversions.h"
#include "gaussmap/pcl/kl_kmeans.h"
#include "gaussmap/pcl/point_gaussian.h"

// After them, as a user may include it.
#include <gtest/gtest.h>
#include <pcl/filters/passthrough.h>

#ifdef PCL_NO_PRECOMPILE
#error "a header of gaussmap defines PCL_NO_PRECOMPILE for all headers of PCL that follow"
#endif
#ifdef PCL_FILTERS_IMPL_PASSTHROUGH_HPP_
#error "pcl::PassThrough would be compiled again"
#endif

namespace gaussmap {
namespace {

TEST(PrecompiledTemplates, AreUsedForPointTypesOfPcl) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < 10; ++i) cloud->emplace_back(static_cast<float>(i), 0.0f, 0.0f);
  pcl::PassThrough<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud);
  filter.setFilterFieldName("x");
  filter.setFilterLimits(1.5f, 4.5f);
  pcl::PointCloud<pcl::PointXYZ> middle;
  filter.filter(middle);
  EXPECT_EQ(middle.size(), 3u);
}

}  // namespace
}  // namespace gaussmap
