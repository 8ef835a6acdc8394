// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of simplify().
struct SimplifyOptions {
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair of clusters is merged next
  int threads = 0;                           ///< 0 = all cores
};

/// Reduces the number of Gaussians of a map to a budget, Yguel 2009 sec. 5.4.
///
/// Clusters of the same cell are merged where the cost is smallest over the whole scale, until the budget is met. This
/// includes the finest scale, if its cells hold several Gaussians. No finer scale is needed, so the function also
/// accepts compressed maps, final maps and maps of one scale. The children of merged clusters become children of the
/// union. Coarse clusters thus stay the moment matches of their children. Every cell keeps at least one Gaussian, and
/// exact moments are kept.
///
/// With MaxError, distances are measured from samples of a scale to samples of the leaves of the given map. The number
/// of Gaussians is found by bisection to within 0.5 %. A scale whose error is already larger is not changed and is
/// listed in RefineResult::not_reached. The result has no error curves.
///
/// Throws std::invalid_argument in these cases:
/// - The budget is out of range; the message names the option.
/// - The map does not have a listed scale, or a limit is below the number of cells of its scale.
/// - MaxBytes: one Gaussian per cell exceeds the limit; the message gives the bytes needed.
template <int D>
GAUSSMAP_API RefineResult<D> simplify(GaussianMap<D> map, const Budget& budget, const SimplifyOptions& options = {});

}  // namespace gaussmap
