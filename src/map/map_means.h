// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// Returns the mean of GaussianMap::localGaussian() [m, relative to the centre of its cell]. It is faster, because it
/// computes no covariance from the moments.
template <int D>
Vector<D> localMean(const GaussianMap<D>& map, std::size_t index, int scale) {
  const MapScale<D>& level = map.scale(scale);
  if (level.moments.empty()) return level.gaussians[index].mean;
  return level.moments[index].mean(map.grid().side(scale));
}

}  // namespace gaussmap::detail
