// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/sensor/range_image.h"

// Sensors for tests, and images of scenes that are given by a formula.
namespace gaussmap::test {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;

/// Returns a lidar with rows of equal height.
inline SphericalProjection lidar(int rows, double lowest_deg, double highest_deg, int columns) {
  SphericalProjection projection;
  for (int border = 0; border <= rows; ++border)
    projection.row_borders.push_back((lowest_deg + (highest_deg - lowest_deg) * border / rows) * kDegree);
  projection.columns = columns;
  return projection;
}

inline PlanarProjection camera() {
  return {60.0, 55.0, 31.5, 23.2, 64, 48};
}

inline Eigen::Vector3d randomDirection(Random& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

/// Returns a random point of the ball. Half of the points are on its surface.
inline Eigen::Vector3d randomPointOfBall(Random& random, const Eigen::Vector3d& centre, double radius) {
  const double r = random.below(2) == 0 ? radius : radius * std::cbrt(random.uniform());
  return centre + r * randomDirection(random);
}

/// Returns an image with one beam through the middle of each pixel. `range` gives the range [m] along a unit vector, or
/// std::nullopt for no return.
inline RangeImage imageOf(const Projection& projection,
                          const std::function<std::optional<double>(const Eigen::Vector3d&)>& range) {
  RangeImage image(projection);
  for (int row = 0; row < image.rows(); ++row)
    for (int column = 0; column < image.columns(); ++column) {
      const Eigen::Vector3d direction = directionOf(projection, {row, column});
      if (const auto here = range(direction)) image.add(*here * direction);
    }
  return image;
}

}  // namespace gaussmap::test
