// SPDX-License-Identifier: BSD-3-Clause
#include "registration/observability.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

using Vector6 = NormalEquations::Vector6;
using Matrix6 = NormalEquations::Matrix6;

Matrix6 diagonal(double a, double b, double c, double d, double e, double f) {
  Vector6 values;
  values << a, b, c, d, e, f;
  return values.asDiagonal();
}

Matrix6 anyInformation(std::uint64_t seed) {
  Random random(seed);
  Matrix6 root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = random.normal();
  return root * root.transpose() + Matrix6::Identity();
}

TEST(HeldDirections, AreThoseWithLittleInformationInMetres) {
  // With a range of 10 m, a rotation with information 100 is as good as a translation with information 1.
  HeldDirections held(10.0);
  EXPECT_FALSE(held.hold(diagonal(1, 1, 1, 100, 100, 100), 0.1));
  EXPECT_TRUE(held.isEmpty());
  EXPECT_TRUE(held.hold(diagonal(1, 0.1, 1, 100, 100, 9), 0.1));
  EXPECT_FALSE(held.isEmpty());
  const Vector6 step = held.step(Matrix6::Identity(), Vector6::Ones());
  EXPECT_NEAR(step[1], 0.0, 1e-12);
  EXPECT_NEAR(step[5], 0.0, 1e-12);
  EXPECT_NEAR(step[0], -1.0, 1e-12);
  EXPECT_NEAR(step[3], -1.0, 1e-12);
}

TEST(HeldDirections, StayHeldWhenOthersAreAdded) {
  HeldDirections held(1.0);
  EXPECT_TRUE(held.hold(diagonal(0, 1, 1, 1, 1, 1), 0.01));
  EXPECT_FALSE(held.hold(diagonal(5, 1, 1, 1, 1, 1), 0.01));  // the first one counts no more
  EXPECT_TRUE(held.hold(diagonal(5, 1, 0, 1, 1, 1), 0.01));
  const Vector6 step = held.step(Matrix6::Identity(), Vector6::Ones());
  EXPECT_NEAR(step[0], 0.0, 1e-12);
  EXPECT_NEAR(step[2], 0.0, 1e-12);
  EXPECT_NEAR(step[1], -1.0, 1e-12);
}

TEST(HeldDirections, ThatAreAllLeaveNoStep) {
  HeldDirections held(2.0);
  EXPECT_TRUE(held.hold(Matrix6::Zero(), 0.01));
  EXPECT_FALSE(held.hold(Matrix6::Identity(), 0.01));
  EXPECT_TRUE(held.step(anyInformation(1), Vector6::Ones()).isZero());
}

TEST(HeldDirections, GiveTheConstrainedMinimum) {
  // The twin: Lagrange multipliers. The step is orthogonal to u, and the rest of the gradient is along u.
  const double range = 3.0;
  const Matrix6 information = anyInformation(2);
  const Vector6 gradient = anyInformation(3).col(0);
  Vector6 u = anyInformation(4).col(0).normalized();  // scaled units
  HeldDirections held(range);
  ASSERT_TRUE(held.hold(
      [&] {
        Vector6 units = Vector6::Ones();
        units.tail<3>().setConstant(range);
        return Matrix6(units.asDiagonal() * (Matrix6::Identity() - u * u.transpose()) * units.asDiagonal());
      }(),
      1e-6));
  const Vector6 step = held.step(information, gradient);
  Vector6 scaled = step;
  scaled.tail<3>() *= range;
  EXPECT_NEAR(scaled.dot(u), 0.0, 1e-9);
  Vector6 rest = information * step + gradient;  // [per unit of the pose]
  rest.tail<3>() /= range;
  EXPECT_LT((rest - rest.dot(u) * u).norm(), 1e-9);
}

TEST(HeldDirections, GiveTheInverseIfThereAreNone) {
  const Matrix6 information = anyInformation(5);
  const HeldDirections none(7.0);
  EXPECT_LT((none.step(information, Vector6::Ones()) + information.inverse() * Vector6::Ones()).norm(), 1e-9);
  EXPECT_LT((Matrix6(none.covarianceOf(information)) - information.inverse()).norm(), 1e-9);
}

TEST(HeldDirections, HaveAVarianceOfTheRangeAndOneRadian) {
  HeldDirections held(20.0);
  ASSERT_TRUE(held.hold(diagonal(0, 1, 1, 400, 400, 0), 0.01));
  const PoseCovariance covariance = held.covarianceOf(diagonal(1e6, 4, 4, 100, 100, 1e6));
  EXPECT_NEAR(covariance(0, 0), 400.0, 1e-9);
  EXPECT_NEAR(covariance(1, 1), 0.25, 1e-9);
  EXPECT_NEAR(covariance(3, 3), 0.01, 1e-9);
  EXPECT_NEAR(covariance(5, 5), 1.0, 1e-9);
}

TEST(LeastObservable, IsTheWeakestDirectionInMetres) {
  EXPECT_NEAR(std::abs(leastObservable(diagonal(1, 1, 0.5, 100, 100, 100), 10.0)[2]), 1.0, 1e-9);
  EXPECT_NEAR(std::abs(leastObservable(diagonal(1, 1, 0.5, 100, 40, 100), 10.0)[4]), 1.0, 1e-9);
}

}  // namespace
}  // namespace gaussmap
