// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "gaussmap/core/gaussian.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"

namespace gaussmap::detail {

/// Pairs of a Gaussian of a scan and its partner in the map, in columns for vector registers. A pair has the residual
/// d^2 = sum over a: tells_a (a' r)^2 / (variance_a + blur^2 + a' R S R' a).
/// Here a are the axes of the map's Gaussian and r = R m + t - mean of the map's Gaussian. m and S are the mean and the
/// covariance of the scan's Gaussian [m, relative to the sensor].
class ResidualBatch {
 public:
  static constexpr std::size_t kCapacity = 64;

  bool isFull() const { return size_ == kCapacity; }
  /// Adds a pair. The batch must not be full.
  void add(const Gaussian<3>& gaussian, const MapGaussian& target);
  /// Returns the normal equations of all pairs, and removes the pairs.
  /// Rotation R, translation t [m], blur^2 [m^2], kernel k.
  NormalEquations sumUp(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation, double blur_squared,
                        double kernel);

  static constexpr std::size_t kLanes = 8;
  using Lanes = double __attribute__((vector_size(8 * kLanes)));
  using Column = Lanes[kCapacity / kLanes];
  /// Covariances: xx xy xz yy yz zz.
  struct Columns {
    Column mean[3], cov[6], target[3], directions[3][3], variances[3], tells[3];
  };

 private:
  Columns columns_;  // filled up to size_
  std::size_t size_ = 0;
};

}  // namespace gaussmap::detail
