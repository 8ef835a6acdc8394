// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/grid.h"
#include "gaussmap/map/sampling.h"

namespace gaussmap::detail {

/// sampleMap() with a box for every Gaussian [m, map frame], outside of which samples are rejected too. No boxes: the
/// cells alone. options.bounds is not used.
template <int D>
MapSamples<D> sampleWithin(const GaussianMap<D>& map, int scale, const std::vector<Box<D>>& boxes,
                           const SampleOptions& options);

}  // namespace gaussmap::detail
