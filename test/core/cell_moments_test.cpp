// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/cell_moments.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace gaussmap {
namespace {

constexpr double kSide = 0.5;
constexpr double kStep = kSide / 65536.0;

TEST(CellMoments, OfTwoPointsAreTheirMidpointAndSpread) {  // offsets +-100 steps along x: variance 100^2
  CellMoments<3> moments;
  moments.add({100, 7, 0});
  moments.add({-100, 7, 0});
  EXPECT_NEAR((moments.mean(kSide) - Eigen::Vector3d(0, 7 * kStep, 0)).norm(), 0.0, 1e-18);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  expected(0, 0) = 1e4 * kStep * kStep;
  EXPECT_NEAR((moments.covariance(kSide) - expected).norm(), 0.0, 1e-18);
}

TEST(CellMoments, KeepTheUpperTriangleByRows) {
  CellMoments<3> moments;
  moments.add({2, 3, 5});
  EXPECT_EQ(moments.product, (std::array<std::int64_t, 6>{4, 6, 10, 9, 15, 25}));
  CellMoments<2> flat;
  flat.add({2, 3});
  EXPECT_EQ(flat.product, (std::array<std::int64_t, 3>{4, 6, 9}));
}

TEST(CellMoments, OfOnePointGetTheNoiseFloor) {
  CellMoments<3> moments;
  moments.add({-32768, 32767, 1});
  const Gaussian<3> gaussian = moments.gaussian(kSide, 0.01);
  EXPECT_NEAR((gaussian.cov - 1e-4 * Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-15);
  EXPECT_EQ(gaussian.weight, 1.0);
}

TEST(CellMoments, OfCollinearAndCoincidentPointsStayPositiveDefinite) {
  Random random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    CellMoments<3> moments;
    const int points = 1 + static_cast<int>(random.below(50));
    for (int i = 0; i < points; ++i) {
      const auto along = static_cast<std::int32_t>(random.below(65536)) - 32768;
      moments.add({along, trial % 2 ? along : 32767, -32768});
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.gaussian(kSide, kSide / 1000).cov);
    EXPECT_GT(solver.eigenvalues().minCoeff(), 0.9e-6 * kSide * kSide);
  }
}

TEST(CellMoments, HoldNearlyTwoToThePowerOf33PointsWithoutOverflow) {
  CellMoments<3> one, all;
  one.add({-32768, -32768, 32767});
  for (int bit = 0; bit < 33; ++bit) {  // 1 + 2 + 4 + ... = 2^33 - 1, the last sum being that of 2^32
    CellMoments<3> power = one;
    for (int doubling = 0; doubling < bit; ++doubling) power += CellMoments<3>(power);
    all += power;
  }
  EXPECT_EQ(all.count, (std::int64_t{1} << 33) - 1);
  EXPECT_NEAR(all.mean(1.0).x(), -0.5, 1e-12);
  EXPECT_NEAR(all.covariance(1.0).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace gaussmap
