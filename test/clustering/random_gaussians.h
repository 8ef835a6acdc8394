// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {

/// Returns `n` Gaussians of any shape and weight around the origin.
template <int D>
std::vector<Gaussian<D>> randomGaussians(Random& random, std::size_t n) {
  std::vector<Gaussian<D>> gaussians(n);
  for (Gaussian<D>& gaussian : gaussians) {
    Matrix<D> factor;
    for (int row = 0; row < D; ++row) {
      gaussian.mean(row) = 2.0 * random.normal();
      for (int column = 0; column < D; ++column) factor(row, column) = random.normal();
    }
    gaussian.cov = factor * factor.transpose() + 0.01 * Matrix<D>::Identity();
    gaussian.weight = 0.1 + random.uniform();
  }
  return gaussians;
}

inline constexpr std::size_t kPatches = 60;  // number per object of wallsAndPole()

/// Returns patches of 10 cm: of a wall x = 0, a wall y = 0 (both 2 m wide and high, without the corner) and a pole at
/// (1.5, 1.5).
inline std::vector<Gaussian<3>> wallsAndPole(Random& random) {
  const auto patch = [&](double x, double y, double z, const Eigen::Vector3d& deviations) {
    const Eigen::Vector3d mean =
        Eigen::Vector3d(x, y, z) + 0.002 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    return Gaussian<3>{mean, deviations.cwiseAbs2().asDiagonal(), 5.0 + 10.0 * random.uniform()};
  };
  const auto coordinate = [&] { return 0.2 + 1.8 * random.uniform(); };
  std::vector<Gaussian<3>> patches;
  for (std::size_t i = 0; i < kPatches; ++i)
    patches.push_back(patch(0, coordinate(), coordinate(), {0.005, 0.03, 0.03}));
  for (std::size_t i = 0; i < kPatches; ++i)
    patches.push_back(patch(coordinate(), 0, coordinate(), {0.03, 0.005, 0.03}));
  for (std::size_t i = 0; i < kPatches; ++i) patches.push_back(patch(1.5, 1.5, coordinate(), {0.01, 0.01, 0.03}));
  return patches;
}

}  // namespace gaussmap
