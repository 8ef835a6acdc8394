// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/sensor_model.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "core/check.h"

namespace gaussmap {
using namespace detail;

namespace {

void check(const SensorNoise& noise) {
  require(std::isfinite(noise.range) && noise.range >= 0.0, "range noise", noise.range,
          "must be finite and not negative");
  require(std::isfinite(noise.bearing) && noise.bearing >= 0.0, "bearing noise", noise.bearing,
          "must be finite and not negative");
}

/// Returns L with L L^T = covariance. The covariance may be singular.
Matrix<3> factor(const Matrix<3>& covariance) {
  if (covariance.isZero(0.0)) return Matrix<3>::Zero();
  const Eigen::LDLT<Eigen::Matrix3d> ldlt(covariance);
  const Eigen::Vector3d root = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Matrix3d lower = ldlt.matrixL();
  return ldlt.transpositionsP().transpose() * (lower * root.asDiagonal());
}

/// h of Leal 2000 eq. [1]: the end of a beam [m], map frame.
Vector<2> end(const Vector<2>& sensor, double heading, double bearing, double range) {
  const double angle = heading + bearing;
  return sensor + Vector<2>(range * std::cos(angle), range * std::sin(angle));
}

}  // namespace

SampledObservations::SampledObservations(const SensorNoise& noise, int samples, std::uint64_t seed)
    : noise_(noise), samples_(samples), seed_(seed) {
  check(noise);
  require(samples >= 1, "samples of an observation", samples, "must be at least 1");
}

void SampledObservations::observe(const LaserScan& scan, std::size_t beam, std::uint64_t number,
                                  std::vector<ObservationPoint>& points) const {
  Random random = Random::forPart(seed_, number);
  const bool certain_pose = scan.pose.covariance.isZero(0.0);
  const Matrix<3> root = factor(scan.pose.covariance);
  const double weight = 1.0 / samples_, range = scan.ranges[beam], bearing = scan.bearings[beam];
  points.clear();
  for (int i = 0; i < samples_; ++i) {
    const double r = range + noise_.range * random.normal(), b = bearing + noise_.bearing * random.normal();
    Vector<2> sensor = scan.pose.translation;
    double heading = scan.pose.heading;
    if (!certain_pose) {
      const double u = random.normal(), v = random.normal(), w = random.normal();
      const Eigen::Vector3d error = root * Eigen::Vector3d(u, v, w);
      sensor += error.head<2>();
      heading += error.z();
    }
    points.push_back({end(sensor, heading, b, r), weight});
  }
}

UnscentedObservations::UnscentedObservations(const SensorNoise& noise) : noise_(noise) {
  check(noise);
}

void UnscentedObservations::observe(const LaserScan& scan, std::size_t beam, std::uint64_t,
                                    std::vector<ObservationPoint>& points) const {
  // Two points per dimension, sqrt(dimensions) standard deviations from the mean, with weight 1 / (2 dimensions) each.
  // For five dimensions these are sqrt(5) and 1/10. An exact pose needs no points, so two dimensions remain.
  const bool certain_pose = scan.pose.covariance.isZero(0.0);
  const int dimensions = certain_pose ? 2 : 5;
  const double far = std::sqrt(static_cast<double>(dimensions)), weight = 0.5 / dimensions;
  const double range = scan.ranges[beam], bearing = scan.bearings[beam];
  const Vector<2>& sensor = scan.pose.translation;
  const double heading = scan.pose.heading;
  const double cosine = std::cos(heading + bearing), sine = std::sin(heading + bearing);
  const double turn = far * noise_.bearing, c = std::cos(turn), s = std::sin(turn);
  points.clear();
  for (const double sign : {-1.0, 1.0}) {
    const double r = range + sign * far * noise_.range;
    points.push_back({sensor + Vector<2>(r * cosine, r * sine), weight});
    points.push_back({sensor + range * Vector<2>(cosine * c - sign * sine * s, sine * c + sign * cosine * s), weight});
  }
  if (certain_pose) return;
  const Matrix<3> root = factor(scan.pose.covariance);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d error = sign * far * root.col(axis);
      points.push_back({end(sensor + error.head<2>(), heading + error.z(), bearing, range), weight});
    }
}

}  // namespace gaussmap
