// SPDX-License-Identifier: BSD-3-Clause
#include "segments/line_spread.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace gaussmap::detail {
namespace {

/// Scans of the wall y = 0 from y = 2: positions of its beams' ends, and where the sensor stood.
struct WallScan {
  double from, to, sensor;
};
const std::vector<WallScan> kScans = {{-2, 1, -1}, {-1, 2, 0}, {0, 3, 2}, {-2, 3, 0}, {-2, 3, 1}, {1, 3, 2}};
constexpr double kBeams = 40, kNoise = 0.01;

/// Least squares line through all beams' ends when every scan has its own pose error: offset and angle about the
/// centre of the ends, and the evidence itself.
LineMoments moments(const Matrix<3>& root, Random& random) {
  LineMoments sum;
  for (const WallScan& scan : kScans) {
    const double u = random.normal(), v = random.normal(), w = random.normal();
    const Eigen::Vector3d error = root * Eigen::Vector3d(u, v, w);
    for (double i = 0; i < kBeams; ++i) {
      const double t = scan.from + (scan.to - scan.from) * i / (kBeams - 1);
      sum.add({t, error.y() + error.z() * (t - scan.sensor) + kNoise * random.normal()});
    }
  }
  return sum;
}

BeamSums sumsOf(const WallScan& scan, double center) {
  BeamSums sums;
  for (double i = 0; i < kBeams; ++i) {
    const double t = scan.from + (scan.to - scan.from) * i / (kBeams - 1) - center;
    sums.n += 1.0;
    sums.t += t;
    sums.tt += t * t;
    sums.variance += kNoise * kNoise;
  }
  return sums;
}

TEST(LineSpread, IsTheCovarianceOfManyTrials) {
  Matrix<3> root = Matrix<3>::Zero();
  root(0, 0) = root(1, 1) = 0.02;
  root(2, 1) = 0.002;
  root(2, 2) = 0.004;
  Random random(5);
  const LineFit truth = fitLine(moments(Matrix<3>::Zero(), random), {1.0, 0.0});
  LineSpread spread;
  std::int64_t number = 0;
  for (const WallScan& scan : kScans)
    spread.addScan(sumsOf(scan, truth.center.x()), truth, {scan.sensor, 2.0}, root * root.transpose(), number++);
  LineFit line = truth;
  line.across = 0.0;  // nothing that the declared errors do not explain
  const Matrix<2> predicted = spread.covariance(line);

  Matrix<2> measured = Matrix<2>::Zero();
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const LineFit fit = fitLine(moments(root, random), {1.0, 0.0});
    const double slope = fit.direction.y() / fit.direction.x();
    const Vector<2> error(fit.center.y() + slope * (truth.center.x() - fit.center.x()), slope);
    measured += error * error.transpose() / kTrials;
  }
  EXPECT_NEAR(predicted(0, 0) / measured(0, 0), 1.0, 0.1);
  EXPECT_NEAR(predicted(1, 1) / measured(1, 1), 1.0, 0.1);
  EXPECT_NEAR(predicted(0, 1), measured(0, 1), 0.1 * std::sqrt(measured(0, 0) * measured(1, 1)));
}

TEST(LineSpread, IsTheSameByPartsOfTheSameScans) {
  const Matrix<3> covariance = Eigen::Vector3d(4e-4, 4e-4, 1e-5).asDiagonal();
  LineFit line;
  line.along = 2.0;
  LineSpread whole, left, right;
  const BeamSums a = sumsOf({-2, 0, 0}, 0.0), b = sumsOf({0, 3, 0}, 0.0);
  BeamSums both = a;
  both.n += b.n;
  both.t += b.t;
  both.tt += b.tt;
  both.variance += b.variance;
  whole.addScan(both, line, {1.0, 2.0}, covariance, 0);
  left.addScan(a, line, {1.0, 2.0}, covariance, 0);
  LineFit other = line;  // the other part knows its own centre
  other.center = {1.5, 0.0};
  right.addScan(sumsOf({0, 3, 0}, 1.5), other, {1.0, 2.0}, covariance, 0);
  right.shift(-1.5);
  left.absorb(right);
  EXPECT_NEAR((left.covariance(line) - whole.covariance(line)).norm(), 0.0, 1e-12);
  // Half of the beams of the same scans know as little about the scans' errors as all of them.
  EXPECT_NEAR(whole.part(0.5).covariance(line)(0, 0) / whole.covariance(line)(0, 0), 1.0, 0.1);
}

TEST(LineSpread, CountsScansWhereNoCovarianceIsDeclared) {
  // Ten scans of 100 beams, 2 cm apart from each other: 2 cm / sqrt(10) at best, not 2 cm / sqrt(1000).
  LineSpread spread;
  LineFit line;
  line.along = 1.0;
  line.across = 4e-4;
  for (std::int64_t scan = 0; scan < 10; ++scan)
    spread.addScan({100.0, 0.0, 100.0, 0.0}, line, {0.0, 2.0}, Matrix<3>::Zero(), scan);
  EXPECT_NEAR(spread.covariance(line)(0, 0), 4e-4 / 10.0 * 10.0 / 8.0, 1e-9);
}

TEST(LineSpread, TurningTwiceChangesNothingAndShiftingBackNeither) {
  LineSpread spread;
  LineFit line;
  line.along = 1.0;
  line.across = 1e-3;
  const Matrix<3> covariance = Eigen::Vector3d(1e-4, 2e-4, 3e-5).asDiagonal();
  spread.addScan({10.0, 3.0, 20.0, 1e-3}, line, {0.5, 2.0}, covariance, 0);
  const Matrix<2> before = spread.covariance(line);
  spread.turn();
  EXPECT_NEAR(spread.covariance(line)(0, 1), -before(0, 1), 1e-15);
  spread.turn();
  spread.shift(2.0);
  EXPECT_GT(spread.covariance(line)(1, 1), before(1, 1));
  spread.shift(-2.0);
  EXPECT_NEAR((spread.covariance(line) - before).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace gaussmap::detail
