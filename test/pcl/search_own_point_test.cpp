// SPDX-License-Identifier: BSD-3-Clause
// A user's own point type: PCL's rule for all of its classes is this line before its headers.
#define PCL_NO_PRECOMPILE
#include <gtest/gtest.h>

#include "gaussmap/pcl/search.h"
#include "pcl/random_surface.h"

namespace gaussmap {
namespace {

TEST(GaussianMapSearch, TakesAUsersOwnPointType) {
  const auto cloud = test::wavyFloor<RingPoint>();
  const auto plain = test::wavyFloor<pcl::PointXYZ>();
  GaussianMapSearch<RingPoint> own;
  GaussianMapSearch<pcl::PointXYZ> usual;
  own.setInputCloud(cloud);
  usual.setInputCloud(plain);
  pcl::Indices indices, expected_indices;
  std::vector<float> squares, expected_squares;
  for (std::size_t i = 0; i < cloud->size(); i += 11) {
    own.radiusSearch((*cloud)[i], 0.25, indices, squares);
    usual.radiusSearch((*plain)[i], 0.25, expected_indices, expected_squares);
    EXPECT_EQ(indices, expected_indices);
    EXPECT_EQ(squares, expected_squares);
    ASSERT_EQ(own.nearestKSearchT((*plain)[i], 1, indices, squares), 1);  // a point of another type
    EXPECT_EQ(std::size_t(indices[0]), i);
  }
}

}  // namespace
}  // namespace gaussmap
