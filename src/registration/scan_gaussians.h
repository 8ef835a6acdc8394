// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// Returns the Gaussians to register: those of the scale whose cells have the side nearest to `side` [m] by ratio. If
/// there are more than `most`, returns an even selection of them.
template <int D>
std::vector<Gaussian<D>> gaussiansOf(const GaussianMap<D>& source, double side, std::size_t most);

/// Returns the root mean square of the distances of the means from the sensor [m], at least 1e-6.
template <int D>
double rmsRangeOf(const std::vector<Gaussian<D>>& scan);

/// Returns true if these are the Gaussians of a scan of a planar laser: lines in one plane.
bool isOfPlanarLaser(const std::vector<Gaussian<3>>& scan);

}  // namespace gaussmap::detail
