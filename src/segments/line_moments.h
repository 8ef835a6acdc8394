// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// Weighted sums of points up to the second order [m, m^2], relative to an origin near them.
struct LineMoments {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void add(const Vector<2>& point, double weight = 1.0) {
    const double wx = weight * point.x(), wy = weight * point.y();
    n += weight;
    x += wx;
    y += wy;
    xx += wx * point.x();
    xy += wx * point.y();
    yy += wy * point.y();
  }
  LineMoments& operator+=(const LineMoments& other) {
    n += other.n;
    x += other.x;
    y += other.y;
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
  }
  friend LineMoments operator+(LineMoments a, const LineMoments& b) { return a += b; }
  friend LineMoments operator-(const LineMoments& a, const LineMoments& b) {
    return {a.n - b.n, a.x - b.x, a.y - b.y, a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
  }
  friend LineMoments operator*(double factor, const LineMoments& m) {
    return {factor * m.n, factor * m.x, factor * m.y, factor * m.xx, factor * m.xy, factor * m.yy};
  }

  Vector<2> mean() const { return {x / n, y / n}; }
  /// Returns the variance of the coordinate along a unit direction [m^2].
  double variance(const Vector<2>& direction) const {
    const double a = direction.x(), b = direction.y(), mean = (a * x + b * y) / n;
    return std::max(0.0, (a * a * xx + 2.0 * a * b * xy + b * b * yy) / n - mean * mean);
  }
  /// Returns the mean squared distance from the line through `point` with unit normal `normal` [m^2].
  double squaredDistance(const Vector<2>& point, const Vector<2>& normal) const {
    const double offset = normal.dot(mean() - point);
    return variance(normal) + offset * offset;
  }
};

/// The least-squares line of a set of points, Leal 2000 eq. [2].
struct LineFit {
  Vector<2> center{0.0, 0.0};     ///< mean of the points [m]
  Vector<2> direction{1.0, 0.0};  ///< first eigenvector, oriented to have the free side on its left
  double along = 0.0;             ///< lambda_1 [m^2]
  double across = 0.0;            ///< lambda_2 = sigma_n^2 [m^2]

  Vector<2> normal() const { return {-direction.y(), direction.x()}; }
  double position(const Vector<2>& point) const { return direction.dot(point - center); }
  double offset(const Vector<2>& point) const { return normal().dot(point - center); }
};

/// Fits the least-squares line. Of its two directions it takes the one nearer to `like`. If no direction is better than
/// the others, it takes `like`.
inline LineFit fitLine(const LineMoments& m, const Vector<2>& like) {
  LineFit fit;
  fit.center = m.mean();
  const double a = m.xx / m.n - fit.center.x() * fit.center.x(), c = m.yy / m.n - fit.center.y() * fit.center.y(),
               b = m.xy / m.n - fit.center.x() * fit.center.y();
  const double half = 0.5 * (a - c), root = std::sqrt(half * half + b * b);
  fit.along = std::max(0.0, 0.5 * (a + c) + root);
  fit.across = std::max(0.0, 0.5 * (a + c) - root);
  if (root > 0.0) {
    // The better conditioned of the two columns of (C - lambda_2 I).
    Vector<2> direction = half >= 0.0 ? Vector<2>(half + root, b) : Vector<2>(b, root - half);
    fit.direction = direction / direction.norm();
    if (fit.direction.dot(like) < 0.0) fit.direction = -fit.direction;
  } else {
    fit.direction = like;
  }
  return fit;
}

/// Returns the summed squared error of the least-squares line [m^2]: weight times lambda_2.
inline double squaredError(const LineMoments& m) {
  if (m.n <= 0.0) return 0.0;
  const double mx = m.x / m.n, my = m.y / m.n, a = m.xx / m.n - mx * mx, c = m.yy / m.n - my * my,
               b = m.xy / m.n - mx * my, half = 0.5 * (a - c);
  return m.n * std::max(0.0, 0.5 * (a + c) - std::sqrt(half * half + b * b));
}

}  // namespace gaussmap::detail
