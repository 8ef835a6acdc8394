// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/member_boxes.h"

#include <gtest/gtest.h>

#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

TEST(MemberBoxes, OfTwoCellsIsTheBoxAroundBoth) {
  const GaussianMapOctree map = build<3>({{0.05, 0.05, 0.05}, {0.35, 0.15, 0.05}}, {0.1, 10, 2, 0.0});
  const std::vector<Box<3>> boxes = memberBoxes<3>(map, 1);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_LT((boxes[0].low - Vector<3>(0, 0, 0)).norm(), 1e-12);
  EXPECT_LT((boxes[0].high - Vector<3>(0.4, 0.2, 0.1)).norm(), 1e-12);
}

TEST(MemberBoxes, HoldTheMeansOfAllDescendants) {
  const GaussianMapOctree map = refine<3>(build<3>(test::randomCloud<3>(3000, 41), {0.1, 4, 3, 0.0}));
  for (int s = 1; s < map.scales(); ++s) {
    const std::vector<Box<3>> boxes = memberBoxes<3>(map, s);
    ASSERT_EQ(boxes.size(), map.gaussianCount(s));
    for (std::size_t i = 0; i < map.gaussianCount(s - 1); ++i) {
      const Box<3>& box = boxes[map.parentOf(i, s - 1)];
      const Vector<3> mean = map.gaussian(i, s - 1).mean;
      EXPECT_TRUE((mean.array() >= box.low.array() - 1e-6).all() && (mean.array() <= box.high.array() + 1e-6).all());
    }
  }
}

}  // namespace
}  // namespace gaussmap
