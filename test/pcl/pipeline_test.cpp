// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/impl/passthrough.hpp>

#include "gaussmap/pcl/dynamic_points_filter.h"
#include "gaussmap/pcl/gaussian_map_filter.h"
#include "gaussmap/pcl/normal_estimation.h"
#include "pcl/random_surface.h"

namespace {

// The pipeline of the README: a scan without moving objects, thinned, with normals.
using Cloud = pcl::PointCloud<pcl::PointXYZI>;
pcl::PointCloud<pcl::Normal>::Ptr prepare(const Cloud::Ptr& scan,
                                          const std::shared_ptr<const gaussmap::GaussianMapOctree>& map) {
  gaussmap::DynamicPointsFilter<pcl::PointXYZI> still;
  still.setMap(map);  // its occupancy tells what is free; the scan's sensor pose moves it into the map
  still.setInputCloud(scan);
  still.filter(*scan);
  gaussmap::GaussianMapFilter<pcl::PointXYZI> thin;
  thin.setMaxError(0.2);  // 95 % of the scan within 20 cm of a kept point
  thin.setInputCloud(scan);
  thin.filter(*scan);
  gaussmap::CellNormalEstimation<pcl::PointXYZI> normals;
  normals.setInputCloud(scan);
  auto result = pcl::make_shared<pcl::PointCloud<pcl::Normal>>();
  normals.compute(*result);
  return result;
}

TEST(Pipeline, RunsOurClassesOneAfterTheOther) {
  const auto scan = gaussmap::test::wavyFloor<pcl::PointXYZI>();
  const auto normals = prepare(scan, std::make_shared<gaussmap::GaussianMapOctree>());
  EXPECT_LT(scan->size(), 600u);
  ASSERT_EQ(normals->size(), scan->size());
  for (const pcl::Normal& normal : *normals) EXPECT_GT(normal.normal_z, 0.0f);
}

}  // namespace
