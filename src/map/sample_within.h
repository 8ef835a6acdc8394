// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/grid.h"
#include "gaussmap/map/sampling.h"

namespace gaussmap::detail {

/// Samples a scale like sampleMap(), but also rejects samples outside the box of their Gaussian [m, map frame]. `boxes`
/// has one box per Gaussian; if it is empty, only the cells limit the samples. options.bounds is not used.
template <int D>
MapSamples<D> sampleWithin(const GaussianMap<D>& map, int scale, const std::vector<Box<D>>& boxes,
                           const SampleOptions& options);

}  // namespace gaussmap::detail
