// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of simplify().
struct GAUSSMAP_API SimplifyOptions {
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair of clusters is merged next
  int threads = 0;                           ///< 0 = all cores
  bool smooth = false;  ///< ends with one run of KLKMeans per cell, which starts from the merged clusters

  /// Returns the options of the paper, Yguel 2009 sec. 5.4: MergeCost::KL, and then one run of the clustering per cell.
  ///
  /// Two things differ from the paper. It fixes the number of clusters per cell; the budgets of simplify() limit the
  /// number per scale. In a cell with more than AgglomerateOptions::max_exact clusters, only pairs of neighbours are
  /// compared.
  static SimplifyOptions yguel2009();
};

/// Reduces the number of Gaussians of a map to a budget, Yguel 2009 sec. 5.4.
///
/// The function merges pairs of clusters of the same cell, until the budget is met. The cheapest merges of the
/// whole scale are made first. The finest scale is simplified too if its cells hold several Gaussians; cells with exact
/// moments hold one and do not change. Compressed maps, final maps and maps of one scale are accepted. The children of
/// merged clusters become children of the union. Coarse clusters thus stay the moment matches of their children. Every
/// cell keeps at least one Gaussian.
///
/// With SimplifyOptions::smooth, the clusters that a cell had before are then assigned to the merged clusters again, by
/// one run of KLKMeans. The run can drop clusters, so fewer than the budget can be left.
///
/// With MaxError, samples are drawn from the scale and from the leaves of the given map. The error is the 95 % quantile
/// of the distances from a sample of the scale to the nearest sample of the leaves. Per scale, a bisection finds the
/// smallest number of Gaussians that keeps the limit, to within 0.5 %. If a scale exceeds the limit before any merge,
/// it does not change and is listed in RefineResult::not_reached. A scale with one Gaussian per cell is never listed.
/// The result has no error curves.
///
/// Throws std::invalid_argument in these cases:
/// - The budget or an option is out of range; the message names it.
/// - MaxGaussians: the map does not have a listed scale, or a limit is below the number of cells of the scale.
/// - MaxBytes: a map with one Gaussian per cell exceeds the limit; the message gives the bytes needed.
template <int D>
GAUSSMAP_API RefineResult<D> simplify(GaussianMap<D> map, const Budget& budget, const SimplifyOptions& options = {});

}  // namespace gaussmap
