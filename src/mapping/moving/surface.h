// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap::detail {

/// A flat piece of a surface; in 2-D, a straight piece of a line.
template <int D>
struct Surface {
  Vector<D> point;   ///< mean of the points [m], about the reference point of SurfaceSums
  Vector<D> normal;  ///< unit length
  double deviation;  ///< standard deviation of the points along the normal [m]

  /// Returns the maximum distance from the surface at which a point still belongs to it [m]. All lengths of the options
  /// are set.
  double thickness(const SharedCellOptions& options) const { return std::max(*options.noise, 3.0 * deviation); }
};

/// Adds up the points of some cells, about one reference point, and fits a surface to them.
template <int D>
class SurfaceSums {
 public:
  /// Adds the points of a cell. `offset` = vector from the reference point to the centre of the cell [m], `side` = side
  /// of the cell [m].
  void add(const CellMoments<D>& moments, double side, const Vector<D>& offset) {
    if (moments.count == 0) return;
    const auto count = static_cast<double>(moments.count);
    const Vector<D> mean = moments.mean(side) + offset;
    n_ += count;
    sum_ += count * mean;
    product_ += count * (moments.covariance(side) + mean * mean.transpose());
  }

  /// Returns the surface on which the points lie, or std::nullopt if they are too few or not flat. Flat means that
  /// their standard deviation along the normal is at most `flatness` [m]. Along the second axis it is at least `extent`
  /// [m].
  std::optional<Surface<D>> surface(double flatness, double extent) const {
    constexpr double kMinPoints = 10.0;  // minimum number of points of a surface
    if (n_ < kMinPoints) return std::nullopt;
    const Vector<D> mean = sum_ / n_;
    const Eigen::Matrix<double, D, D> spread = product_ / n_ - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> axes(spread);
    const double across = std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
    const double along = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
    if (across > flatness || along < extent) return std::nullopt;
    return Surface<D>{mean, axes.eigenvectors().col(0), across};
  }

 private:
  double n_ = 0.0;
  Vector<D> sum_ = Vector<D>::Zero();
  Matrix<D> product_ = Matrix<D>::Zero();
};

}  // namespace gaussmap::detail
