// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_gaussians.h"

#include <gtest/gtest.h>

#include "gaussmap/mapping/build.h"

namespace gaussmap {
using namespace detail;

namespace {

TEST(GaussiansOf, AScanAreTakenFromAllOfItWhenItIsLarge) {
  std::vector<Vector<3>> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(0.25 + 0.5 * i, 0.25, 0.25);
  const std::vector<Gaussian<3>> taken = gaussiansOf<3>(build<3>(points, {0.5, 4, 2, 0.0}), 0.5, 10);
  ASSERT_EQ(taken.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(taken[i].mean.x(), 0.25 + 50.0 * double(i), 1e-3);
}

TEST(GaussiansOf, AMapAreThoseOfTheScaleThatFits) {
  const GaussianMapOctree map = build<3>({{0.1, 0.1, 0.1}, {0.9, 0.1, 0.1}, {3.1, 0.1, 0.1}}, {0.5, 4, 2, 0.0});
  EXPECT_EQ(gaussiansOf<3>(map, 0.5, 9).size(), 3u);
  EXPECT_EQ(gaussiansOf<3>(map, 1.9, 9).size(), 2u);
  EXPECT_EQ(gaussiansOf<3>(map, 50.0, 9).size(), 2u);
  EXPECT_TRUE(gaussiansOf<3>(GaussianMapOctree(), 0.5, 9).empty());
}

}  // namespace
}  // namespace gaussmap
