// SPDX-License-Identifier: BSD-3-Clause
#include "segments/line_moments.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace gaussmap::detail {
namespace {

TEST(LineMoments, TheLineIsTheFirstEigenvectorOfTheCovariance) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    LineMoments moments;
    std::vector<Vector<2>> points;
    const double angle = 6.3 * random.uniform(), flat = random.uniform();
    for (int i = 0; i < 20; ++i) {
      const double t = random.normal(), d = flat * random.normal();
      points.emplace_back(3.0 + t * std::cos(angle) - d * std::sin(angle),
                          -2.0 + t * std::sin(angle) + d * std::cos(angle));
      moments.add(points.back());
    }
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Vector<2>& point : points) mean += point / 20.0;
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    for (const Vector<2>& point : points) covariance += (point - mean) * (point - mean).transpose() / 20.0;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);

    const Vector<2> like(std::cos(angle), std::sin(angle));
    const LineFit fit = fitLine(moments, like);
    EXPECT_NEAR((fit.center - mean).norm(), 0.0, 1e-12);
    EXPECT_NEAR(fit.across, solver.eigenvalues()(0), 1e-12);
    EXPECT_NEAR(fit.along, solver.eigenvalues()(1), 1e-12);
    EXPECT_NEAR(std::abs(fit.direction.dot(solver.eigenvectors().col(1))), 1.0, 1e-9);
    EXPECT_GE(fit.direction.dot(like), 0.0);
    EXPECT_NEAR(squaredError(moments), 20.0 * fit.across, 1e-10);
  }
}

TEST(LineMoments, VerticalHorizontalAndDiagonalLinesAreExact) {
  for (const Vector<2>& along : {Vector<2>(1, 0), Vector<2>(0, 1), Vector<2>(0.6, -0.8), Vector<2>(-0.6, -0.8)}) {
    LineMoments moments;
    for (int i = -3; i <= 3; ++i) moments.add(Vector<2>(5, 7) + i * along);
    const LineFit fit = fitLine(moments, along);
    EXPECT_NEAR((fit.direction - along).norm(), 0.0, 1e-12);
    EXPECT_NEAR(fit.across, 0.0, 1e-12);
    EXPECT_NEAR(fit.along, 4.0, 1e-12);
  }
}

TEST(LineMoments, WithoutADirectionOfItsOwnALineKeepsTheOneItHad) {
  LineMoments point;
  for (int i = 0; i < 3; ++i) point.add({2.0, 3.0});
  const LineFit fit = fitLine(point, {0.6, 0.8});
  EXPECT_EQ(fit.direction, Vector<2>(0.6, 0.8));
  EXPECT_DOUBLE_EQ(fit.along, 0.0);
}

TEST(LineMoments, TheMeanSquaredDistanceFromALineIsThatOfThePoints) {
  LineMoments moments;
  moments.add({0.0, 1.0});
  moments.add({5.0, 3.0}, 3.0);
  EXPECT_NEAR(moments.squaredDistance({9.0, 0.0}, {0.0, 1.0}), (1.0 + 3.0 * 9.0) / 4.0, 1e-12);
}

}  // namespace
}  // namespace gaussmap::detail
