// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

// A planar map lies in the plane z = 0 of the map frame. These functions put its points and Gaussians there.

inline Vector<3> inSpace(const Vector<2>& point) {
  return {point.x(), point.y(), 0.0};
}

inline std::vector<Vector<3>> inSpace(const std::vector<Vector<2>>& points) {
  std::vector<Vector<3>> result;
  result.reserve(points.size());
  for (const Vector<2>& point : points) result.push_back(inSpace(point));
  return result;
}
/// Points in space stay as they are, so that templates can call inSpace() for any dimension.
inline const std::vector<Vector<3>>& inSpace(const std::vector<Vector<3>>& points) {
  return points;
}
inline std::vector<Vector<3>> inSpace(std::vector<Vector<3>>&& points) {
  return std::move(points);
}

/// Returns a planar Gaussian as a Gaussian in space. `noise` is its standard deviation across the plane [m].
inline Gaussian<3> inSpace(const Gaussian<2>& gaussian, double noise) {
  Gaussian<3> result{inSpace(gaussian.mean), Matrix<3>::Zero(), gaussian.weight};
  result.cov.topLeftCorner<2, 2>() = gaussian.cov;
  result.cov(2, 2) = noise * noise;
  return result;
}

}  // namespace gaussmap::detail
