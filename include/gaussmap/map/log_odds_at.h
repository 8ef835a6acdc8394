// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

/// Log-odds that something is at a point [m, map frame], as the map has them at its finest there: of the Gaussian
/// nearest to the point (Mahalanobis) in the finest cell that holds it. Nothing where the map has no cell, or the point
/// none (not finite, too far).
template <int D>
std::optional<float> logOddsAt(const GaussianMap<D>& map, const Vector<D>& point);

}  // namespace gaussmap
