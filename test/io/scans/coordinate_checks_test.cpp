// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/coordinate_checks.h"

#include <gtest/gtest.h>

#include <random>

namespace gaussmap::detail {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Points that are spread evenly over a box around `middle`.
Points spread(const Eigen::Vector3d& half, const Eigen::Vector3d& middle = Eigen::Vector3d::Zero()) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  Points points;
  for (int i = 0; i < 400; ++i)
    points.emplace_back(middle + Eigen::Vector3d(share(random), share(random), share(random)).cwiseProduct(half));
  return points;
}

Points asFloats(Points points) {
  for (Eigen::Vector3d& point : points) point = point.cast<float>().cast<double>();
  return points;
}

std::string warningsAbout(const Points& points, double resolution, bool is_ascii = false) {
  std::string all;
  for (const std::string& warning : warningsOf({{"a.pcd", is_ascii, points}, {"b.pcd", is_ascii, points}}, resolution))
    all += warning + "\n";
  return all;
}

TEST(CoordinateChecks, ReportFloatsThatAreCoarserThanATenthOfACell) {
  const Points near = asFloats(spread({40, 40, 3}, {3000, 2000, 10}));
  EXPECT_EQ(warningsAbout(near, 0.1), "");
  const Points far = asFloats(spread({40, 40, 3}, {690000, 5330000, 500}));  // steps of 0.5 m
  const std::string text = warningsAbout(far, 0.2);
  EXPECT_NE(text.find("a.pcd and 1 more: "), std::string::npos) << text;
  EXPECT_NE(text.find("steps of 0.5 m"), std::string::npos) << text;
  EXPECT_NE(text.find("doubles (in PCD files: SIZE 8)"), std::string::npos) << text;
  EXPECT_NE(warningsAbout(far, 0.2, true).find("Change SIZE"), std::string::npos);
  EXPECT_EQ(warningsAbout(far, 10.0), "");
  EXPECT_EQ(warningsAbout(spread({40, 40, 3}, {690000, 5330000, 500}), 0.2), "");  // real doubles
}

TEST(CoordinateChecks, ReportMillimetres) {
  const auto asked = [](const Points& points) {
    return warningsAbout(points, 0.1).find("millimetres?") != std::string::npos;
  };
  EXPECT_TRUE(asked(spread({4000, 3000, 1300})));               // a room
  EXPECT_TRUE(asked(spread({4000, 3000, 1300}, {0, 0, 7e6})));  // and far from the origin
  EXPECT_TRUE(asked(spread({6000, 6000, 0})));                  // a planar laser
  Points whole = spread({900, 500, 60});
  for (Eigen::Vector3d& point : whole) point = point.array().round();
  EXPECT_TRUE(asked(whole));  // the whole numbers of a depth camera
  EXPECT_FALSE(asked(spread({900, 500, 60})));
  EXPECT_FALSE(asked(spread({80, 80, 10})));                           // a lidar
  EXPECT_FALSE(asked(spread({3000, 3000, 60}, {690000, 5.33e6, 0})));  // a town
  EXPECT_FALSE(asked(spread({30, 30, 0})));
  EXPECT_FALSE(asked({}));
  EXPECT_FALSE(asked({{1e300, 0, 0}, {-1e300, 1e300, 1e300}}));
}

TEST(CoordinateSamples, DoNotDependOnTheOrderOfTheReads) {
  constexpr std::size_t kSize = 5000;
  const auto blockAt = [](std::size_t first) {
    PointBlock<3> block;
    block.size = std::min(PointBlock<3>::kCapacity, kSize - first);
    for (std::size_t i = 0; i < block.size; ++i)
      for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][i] = static_cast<double>(first + i) + 0.1 * axis;
    return block;
  };
  CoordinateSamples forward(2), backward(2);
  std::vector<std::size_t> firsts;
  for (std::size_t first = 0; first < kSize; first += PointBlock<3>::kCapacity) firsts.push_back(first);
  for (const std::size_t first : firsts) forward.add(1, first, blockAt(first), kSize);
  for (auto first = firsts.rbegin(); first != firsts.rend(); ++first) {
    backward.add(1, *first, blockAt(*first), kSize);
    backward.add(1, *first, blockAt(*first), kSize);
  }
  EXPECT_EQ(forward.of(1), backward.of(1));
  EXPECT_GT(forward.of(1).size(), 1000u);
  EXPECT_LT(forward.of(1).size(), 2100u);
  EXPECT_TRUE(forward.of(0).empty());
}

}  // namespace
}  // namespace gaussmap::detail
