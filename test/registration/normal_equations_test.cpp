// SPDX-License-Identifier: BSD-3-Clause
#include "registration/normal_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "gaussmap/gaussian/random.h"
#include "gaussmap/mapping/build.h"
#include "registration/scan_gaussians.h"

namespace gaussmap {
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

TEST(NormalEquations, HaveTheDerivativesThatDifferencesGive) {
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
      return linearise(scan, where, near, 2.0, 1);
    };
    const NormalEquations here = at(pose);
    const Vector6 slope = slopeOf(pose, [&](const Pose& where) { return at(where).cost; });
    EXPECT_EQ(here.information, here.information.transpose());
    EXPECT_LT((here.gradient - slope).norm(), 1e-6 * (1.0 + slope.norm())) << k;
  }
}

TEST(NormalEquations, HaveTheInformationOfALinearProblem) {
  // Without a kernel the cost is quadratic in the translation: its second differences are twice the information.
  Random random(2);
  const MapGaussian target{
      direction(random), Eigen::Quaterniond::UnitRandom().toRotationMatrix(), {0.01, 0.2, 0.5}, {1.0, 0.4, 0.1}};
  const Gaussian<3> gaussian{direction(random), Vector<3>(0.1, 0.2, 0.3).asDiagonal(), 1.0};
  const Pose pose = anyPose(random);
  const auto at = [&](const Pose& where) {
    NormalEquations sums;
    addResidual(gaussian, where, target, 0.02, 1e9, sums);
    return sums;
  };
  constexpr double kStep = 0.1;
  const NormalEquations here = at(pose);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector6 step = kStep * Vector6::Unit(axis);
    const double bend = (at(moved(pose, step)).cost - 2.0 * here.cost + at(moved(pose, -step)).cost) / (kStep * kStep);
    EXPECT_NEAR(here.information(axis, axis), 0.5 * bend, 1e-8 * bend);
  }
  const Eigen::Matrix3d slope_of_arm = here.information.topRightCorner<3, 3>();
  const Eigen::Vector3d arm = pose.rotation * gaussian.mean;
  const Eigen::Matrix3d straight = here.information.topLeftCorner<3, 3>();
  for (int axis = 0; axis < 3; ++axis)  // a turn about `axis` moves the point by axis x arm
    EXPECT_LT((slope_of_arm.col(axis) - straight * Eigen::Vector3d::Unit(axis).cross(arm)).norm(), 1e-9);
}

TEST(NormalEquations, KnowNothingAlongAnAxisThatFillsItsCell) {
  const MapGaussian wall{{0, 0, 0}, Matrix<3>::Identity(), {0.0004, 0.0833, 0.0833}, {1.0, 0.0, 0.0}};
  NormalEquations sums;
  addResidual({{0.04, 0.3, -0.2}, Matrix<3>::Zero(), 1.0}, Pose(), wall, 0.0012, 1e9, sums);
  EXPECT_NEAR(sums.cost, 0.04 * 0.04 / 0.0016, 1e-12);  // across the wall only
  EXPECT_NEAR(sums.information(0, 0), 1.0 / 0.0016, 1e-9);
  EXPECT_EQ(sums.information(1, 1), 0.0);
}

TEST(NormalEquations, HearHalfOfAResidualAtTheKernel) {
  const MapGaussian ball{{0, 0, 0}, Matrix<3>::Identity(), {1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}};
  NormalEquations sums;
  addResidual({{3.0, 0.0, 0.0}, Matrix<3>::Zero(), 1.0}, Pose(), ball, 0.0, 3.0, sums);
  EXPECT_NEAR(sums.cost, 4.5, 1e-12);
  EXPECT_NEAR(sums.information(1, 1), 0.25, 1e-12);  // (1 / (1 + 1))^2
}

TEST(MapNeighbours, FindTheNearestOfTheEightCellsAroundAPoint) {
  Random random(3);
  std::vector<Vector<3>> points;
  for (int i = 0; i < 3000; ++i) points.emplace_back(4 * random.uniform(), 4 * random.uniform(), 2 * random.uniform());
  const GaussianMapOctree map = build<3>(points, {0.5, 2, 2, 0.0});
  const Vector<3> origin(1.0, 2.0, 0.5);
  for (const int scale : {0, 1}) {
    const double blur = 0.1, side = map.grid().side(scale);
    MapNeighbours near(map, scale, origin);
    near.setBlur(1.0);  // what is found before does not stay
    near.listAt(Vector<3>::Zero());
    near.setBlur(blur);
    for (int k = 0; k < 200; ++k) {
      const Vector<3> point(5 * random.uniform() - 0.5, 5 * random.uniform() - 0.5, 3 * random.uniform() - 0.5);
      double least = std::numeric_limits<double>::infinity();
      Vector<3> brute = Vector<3>::Zero();
      for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) {
        const Vector<3> centre = map.grid().centre(map.scale(scale).keys[map.cellOf(i, scale)], scale);
        if ((centre - point).cwiseAbs().maxCoeff() > side) continue;  // of the cell or the nearer one beside it
        Gaussian<3> wide = map.gaussian(i, scale);
        wide.cov += blur * blur * Matrix<3>::Identity();
        const double squared = mahalanobisSquared<3>(point, wide);
        if (squared >= least) continue;
        least = squared;
        brute = wide.mean;
      }
      const std::uint32_t found = near.nearest(near.listAt(point - origin), point - origin);
      ASSERT_EQ(found == MapNeighbours::kNone, std::isinf(least));
      if (found == MapNeighbours::kNone) continue;
      near.prepare(found);
      EXPECT_LT((near[found].mean + origin - brute).norm(), 1e-9);
    }
  }
  MapNeighbours near(map, 0, origin);
  EXPECT_EQ(near.listAt(Vector<3>(1e300, 0, 0)), MapNeighbours::kNone);
}

TEST(GaussiansOf, AScanAreTakenFromAllOfItWhenItIsLarge) {
  std::vector<Vector<3>> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(0.25 + 0.5 * i, 0.25, 0.25);
  const std::vector<Gaussian<3>> taken = gaussiansOf(build<3>(points, {0.5, 4, 2, 0.0}), 0.5, 10);
  ASSERT_EQ(taken.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(taken[i].mean.x(), 0.25 + 50.0 * double(i), 1e-3);
}

TEST(GaussiansOf, AMapAreThoseOfTheScaleThatFits) {
  const GaussianMapOctree map = build<3>({{0.1, 0.1, 0.1}, {0.9, 0.1, 0.1}, {3.1, 0.1, 0.1}}, {0.5, 4, 2, 0.0});
  EXPECT_EQ(gaussiansOf(map, 0.5, 9).size(), 3u);
  EXPECT_EQ(gaussiansOf(map, 1.9, 9).size(), 2u);
  EXPECT_EQ(gaussiansOf(map, 50.0, 9).size(), 2u);
  EXPECT_TRUE(gaussiansOf(GaussianMapOctree(), 0.5, 9).empty());
}

}  // namespace
}  // namespace gaussmap
