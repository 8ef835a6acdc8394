// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct SimplifyOptions {
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair of clusters is merged next
  int threads = 0;                           ///< 0 = all cores
};

/// Fewer Gaussians, Yguel 2009 sec. 5.4: clusters of a cell are merged where it costs least, summed over the scale,
/// until there are as few as the budget says; at the finest scale too where its cells hold several. No finer scale is
/// needed, whatever the map still has: compressed and final maps, maps of one scale. What is linked to merged clusters
/// is linked to their union, so that coarse clusters stay the moment matches of what they represent. A cell keeps one
/// Gaussian at least; exact moments stay.
///
/// MaxError measures the distances from samples of a scale to those of the finest that the given map has (leaves()),
/// and bisects to half a percent. A scale that is farther away already stays as it is and is listed in `not_reached`.
/// The result has no curves. Throws std::invalid_argument, naming the option, for a budget out of range, a scale that
/// the map does not have, fewer Gaussians than a scale has cells, and MaxBytes that one Gaussian per cell exceeds
/// (naming the bytes that it takes).
template <int D>
GAUSSMAP_API RefineResult<D> simplify(GaussianMap<D> map, const Budget& budget, const SimplifyOptions& options = {});

}  // namespace gaussmap
