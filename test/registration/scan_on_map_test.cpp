// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_on_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap {
using namespace detail;

namespace {

using Vector6 = NormalEquations::Vector6;

Vector<3> direction(Random& random) {
  return Vector<3>(random.normal(), random.normal(), random.normal()).normalized();
}

Pose anyPose(Random& random) {
  return {0.1 * direction(random), Pose::Rotation(Eigen::AngleAxisd(random.uniform(), direction(random)))};
}

/// Half the slope of the cost along each axis, by differences.
template <typename CostAt>
Vector6 slopeOf(const Pose& pose, const CostAt& cost) {
  constexpr double kStep = 1e-6;
  Vector6 slope;
  for (int axis = 0; axis < 6; ++axis) {
    const Vector6 step = kStep * Vector6::Unit(axis);
    slope[axis] = 0.25 * (cost(moved(pose, step)) - cost(moved(pose, -step))) / kStep;
  }
  return slope;
}

TEST(ScanOnMap, HasTheDerivativesThatDifferencesGive) {
  const GaussianMapOctree map =
      build<3>({{0.4, 0.5, 0.55}, {0.5, 0.52, 0.4}, {0.6, 0.45, 0.5}, {0.45, 0.6, 0.5}}, {1.0, 2, 1, 0.05});
  ASSERT_EQ(map.gaussianCount(0), 1u);  // one to meet: the nearest is always the same
  Random random(1);
  for (int k = 0; k < 20; ++k) {
    std::vector<Gaussian<3>> scan;
    for (int i = 0; i < 3; ++i)
      scan.push_back({Vector<3>(0.5, 0.5, 0.5) + 0.4 * direction(random), 1e-30 * Matrix<3>::Identity(), 1.0});
    const Pose pose = anyPose(random);
    const auto at = [&](const Pose& where) {
      MapNeighbours near(map, 0, Vector<3>::Zero());
      near.setBlur(0.2);
      return ScanOnMap(scan, near, 2.0, 1).linearise(where);
    };
    const NormalEquations here = at(pose);
    const Vector6 slope = slopeOf(pose, [&](const Pose& where) { return at(where).cost; });
    EXPECT_LT((here.gradient - slope).norm(), 1e-6 * (1.0 + slope.norm())) << k;
  }
}

TEST(ScanOnMap, GoesAnyWayToAPoseAndFindsTheSameThere) {
  Random random(4);
  std::vector<Vector<3>> points;
  for (int i = 0; i < 4000; ++i)
    points.emplace_back(8 * random.uniform(), 8 * random.uniform(), 0.3 * random.uniform());
  const GaussianMapOctree map = build<3>(points, {0.5, 3, 2, 0.0});
  std::vector<Gaussian<3>> scan;
  for (int i = 0; i < 700; ++i)
    scan.push_back({Vector<3>(9 * random.uniform(), 9 * random.uniform(), random.uniform()) - Vector<3>(4, 4, 0),
                    0.01 * Matrix<3>::Identity(), 1.0});
  const Vector<3> origin(4, 4, 0);
  MapNeighbours near(map, 0, origin);
  near.setBlur(0.1);
  ScanOnMap on_map(scan, near, 3.0, 1);
  Pose pose;
  for (int k = 0; k < 40; ++k) {
    Vector6 step;  // every other pose is near the one before, where most lists stay
    step << 0.05 * direction(random), 0.003 * direction(random);
    pose = k % 2 == 0 ? anyPose(random) : moved(pose, step);
    const NormalEquations here = on_map.linearise(pose);
    MapNeighbours fresh(map, 0, origin);
    fresh.setBlur(0.1);
    const NormalEquations there = ScanOnMap(scan, fresh, 3.0, 2).linearise(pose);
    EXPECT_EQ(here.information, there.information);
    EXPECT_EQ(here.gradient, there.gradient);
    EXPECT_EQ(here.cost, there.cost);
    EXPECT_EQ(here.met, there.met);
    EXPECT_EQ(here.near, there.near);
  }
}

TEST(ScanOnMap, CountsWhatMeetsNothingAsMuchAsCanBe) {
  const GaussianMapOctree map = build<3>({{0.5, 0.5, 0.5}}, {1.0, 2, 1, 0.05});
  MapNeighbours near(map, 0, Vector<3>::Zero());
  const std::vector<Gaussian<3>> scan(300, {Vector<3>(50, 0, 0), Matrix<3>::Identity(), 1.0});
  const NormalEquations sums = ScanOnMap(scan, near, 2.0, 1).linearise(Pose());
  EXPECT_EQ(sums.met, 0u);
  EXPECT_EQ(sums.cost, 300 * 4.0);
  EXPECT_TRUE(sums.information.isZero(0.0));
}

}  // namespace
}  // namespace gaussmap
