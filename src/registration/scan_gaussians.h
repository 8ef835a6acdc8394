// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// The Gaussians that are moved onto the map: those of the scale whose cells are nearest to a side [m], at most `most`,
/// evenly chosen.
std::vector<Gaussian<3>> gaussiansOf(const GaussianMap<3>& source, double side, std::size_t most);

}  // namespace gaussmap::detail
