// SPDX-License-Identifier: BSD-3-Clause
#include "editing/ellipsoid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kRadius = 2.795483482915108;  // standard deviations, sqrt of the 95 % quantile of chi^2 with 3 degrees

Gaussian<3> gaussianOf(const Vector<3>& mean, const Matrix<3>& axes, const Vector<3>& deviations) {
  return {mean, axes * deviations.cwiseAbs2().asDiagonal() * axes.transpose(), 1.0};
}

Matrix<3> randomRotation(Random& random) {
  return Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized()
      .toRotationMatrix();
}

/// Jumps about on the surface, ever less far, and stays where it is nearer.
double distanceByTrying(const Vector<3>& point, const Gaussian<3>& gaussian, Random& random) {
  const PrincipalAxes<3> principal = principalAxes<3>(gaussian);
  const Vector<3> half = kRadius * principal.variances.cwiseSqrt();
  Vector<3> best_unit(1.0, 0.0, 0.0);
  double best = std::numeric_limits<double>::infinity();
  for (double width = 10.0; width > 1e-5; width *= 0.9995) {
    const Vector<3> jump(random.normal(), random.normal(), random.normal());
    const Vector<3> unit = (best_unit + width * jump).normalized();
    const double distance = (gaussian.mean + principal.directions * half.cwiseProduct(unit) - point).norm();
    if (distance < best) {
      best = distance;
      best_unit = unit;
    }
  }
  return best;
}

TEST(Ellipsoid95, OfASphereIsTheDistanceToItsCentreLessTheRadius) {
  const Ellipsoid95<3> ball({{1.0, 2.0, 3.0}, 0.04 * Matrix<3>::Identity(), 7.0});
  EXPECT_NEAR(ball.distance({1.0, 2.0, 13.0}), 10.0 - 0.2 * kRadius, 1e-12);
  EXPECT_NEAR(ball.distance({1.0 - 3.0, 2.0 + 4.0, 3.0}), 5.0 - 0.2 * kRadius, 1e-12);
  EXPECT_EQ(ball.distance({1.0, 2.0, 3.0}), 0.0);
  EXPECT_EQ(ball.distance({1.0, 2.5, 3.0}), 0.0);
}

TEST(Ellipsoid95, AlongAnAxisIsTheDistanceToItsTip) {
  const Ellipsoid95<3> plate(gaussianOf({0, 0, 0}, Matrix<3>::Identity(), {3.0, 2.0, 0.01}));
  EXPECT_NEAR(plate.distance({20.0, 0.0, 0.0}), 20.0 - 3.0 * kRadius, 1e-12);
  EXPECT_NEAR(plate.distance({0.0, -20.0, 0.0}), 20.0 - 2.0 * kRadius, 1e-12);
  EXPECT_NEAR(plate.distance({0.0, 0.0, 5.0}), 5.0 - 0.01 * kRadius, 1e-12);
}

TEST(Ellipsoid95, HoldsNineteenOfTwentySamples) {
  Random random(3);
  const Gaussian<3> gaussian = gaussianOf({5, -5, 1}, randomRotation(random), {2.0, 0.5, 0.1});
  const Ellipsoid95<3> ellipsoid(gaussian);
  const GaussianSampler<3> sampler(gaussian);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) inside += ellipsoid.distance(sampler(random)) == 0.0;
  EXPECT_NEAR(inside, 19000, 120);  // four standard deviations
}

TEST(Ellipsoid95, AgreesWithTryingAllOverItsSurface) {
  Random random(4);
  for (int i = 0; i < 60; ++i) {
    Vector<3> deviations, offset, direction;
    for (int axis = 0; axis < 3; ++axis) {
      deviations(axis) = std::pow(10.0, -2.0 * random.uniform());
      offset(axis) = 100.0 * random.normal();
      direction(axis) = random.normal();
    }
    const Gaussian<3> gaussian = gaussianOf(offset, randomRotation(random), deviations);
    const Vector<3> point = offset + 2.0 * direction;
    const Ellipsoid95<3> ellipsoid(gaussian);
    const double distance = ellipsoid.distance(point);
    if (distance == 0.0)
      EXPECT_LE(mahalanobisSquared<3>(point, gaussian), kRadius * kRadius * (1.0 + 1e-12));
    else
      EXPECT_NEAR(distance, distanceByTrying(point, gaussian, random), 1e-4 * distance);
  }
}

TEST(Ellipsoid95, KnowsNeedlesAndSheetsOfAnyThickness) {
  for (const double thin : {1e-1, 1e-3, 1e-5, 1e-7}) {
    const Ellipsoid95<3> needle(gaussianOf({0, 0, 0}, Matrix<3>::Identity(), {1.0, thin, thin}));
    EXPECT_NEAR(needle.distance({0.0, 3.0, 4.0}), 5.0 - thin * kRadius, 1e-9);
    EXPECT_NEAR(needle.distance({kRadius + 1.0, 0.0, 0.0}), 1.0, 1e-9);
    const Ellipsoid95<3> sheet(gaussianOf({0, 0, 0}, Matrix<3>::Identity(), {1.0, 1.0, thin}));
    EXPECT_NEAR(sheet.distance({0.0, 0.0, -2.0}), 2.0 - thin * kRadius, 1e-9);
    EXPECT_NEAR(sheet.distance({kRadius + 3.0, 0.0, 0.0}), 3.0, 1e-9);
    EXPECT_LT(sheet.distance({1.0, 1.0, 2.0 * kRadius * thin}), 2.0 * kRadius * thin);
  }
}

TEST(Ellipsoid95, FarFromTheOriginIsTheSame) {
  const Vector<3> far(1e7, -1e7, 1e7), point(4.0, 3.0, -2.0);
  Random random(5);
  const Gaussian<3> here = gaussianOf({0, 0, 0}, randomRotation(random), {1.0, 0.3, 0.02});
  Gaussian<3> there = here;
  there.mean = far;
  EXPECT_NEAR(Ellipsoid95<3>(there).distance(far + point), Ellipsoid95<3>(here).distance(point), 1e-8);
}

}  // namespace
}  // namespace gaussmap
