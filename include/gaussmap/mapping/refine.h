// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/budget.h"

namespace gaussmap {

enum class RefineMethod {
  Agglomerate,  ///< bottom-up: from all finer Gaussians, merged where it costs least (agglomerate())
  Insert,  ///< top-down, as in the paper: from one Gaussian per cell, one more where the error is (insertCluster())
};

struct RefineOptions {
  RefineMethod method = RefineMethod::Agglomerate;
  // Agglomerate only:
  MergeCost merge_cost = MergeCost::Volume;
  std::optional<CurveOptions> curves;  ///< measure what other budgets would give; D = 3 only
  // Insert only:
  int queue = 0;       ///< p, cells refined at a time, >= 1; 0: cells / 250, at least 4
  int max_swaps = 20;  ///< limit of the rounds of the swap loop per inserted cluster, >= 0
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;
  std::uint64_t seed = 0;  ///< same map + same seed = same bytes, at any number of threads
  // Both:
  int threads = 0;  ///< 0 = all cores

  /// The paper as printed (Yguel 2009): clusters are inserted (sec. 5.2), into the p = 4 cells of largest error (eq.
  /// (6)) at a time, and each new cluster starts at the datum of largest distortion with that datum's own covariance
  /// (Algorithm 2, lines 5, 18 and 21). The defaults differ where that gives better maps: agglomeration instead of
  /// insertion; for insertion larger rounds, which keep all threads busy, and the covariance of the cluster that the
  /// datum leaves.
  static RefineOptions yguel2009();
};

/// Gives the coarse scales more Gaussians where one per cell represents the finer ones badly. The result depends on the
/// finest scale only: from the finest to the coarsest, every coarse scale is rebuilt and gets as many Gaussians as the
/// budget allows (one per finer Gaussian at most). The finest scale does not change. The map is moved, not copied:
/// refine(std::move(map)) needs no second finest scale.
///
/// Agglomerate: the finer Gaussians z_j under a cell, blurred by half a finest cell, weighted by the number of occupied
/// finest cells that they represent, are merged to a dendrogram (agglomerate()). From the top of all dendrograms of the
/// scale, the merges that cost most are undone, until the budget is used. No random numbers.
///
/// Insert, Yguel 2009 sec. 5: as long as the budget lasts, the p cells of largest error (eq. (6)) get one more cluster
/// each (insertCluster(), Algorithm 2) and return to the queue with their new error. A cell leaves the queue when it
/// has a cluster for every finer Gaussian, its error is 0, or its data allow no more clusters; then less than the
/// budget is used.
///
/// Every cluster is the moment match (weights = numbers of points) of the finer Gaussians whose `parent` it is, so that
/// the total weight of a scale stays the number of points.
///
/// Error curves, MaxBytes and MaxError need one dendrogram for all budgets: agglomeration, and D = 3. The curve of a
/// scale is measured over the finer scale as it was refined. A scale that does not reach MaxError gets as many
/// Gaussians as the finer one and is listed in `not_reached`. Throws std::invalid_argument, naming the option, for a
/// budget or an option out of range, for MaxBytes that one Gaussian per cell exceeds (naming the bytes that it takes),
/// and for a compressed map.
template <int D>
RefineResult<D> refine(GaussianMap<D> map, const Budget& budget = PerCell{}, const RefineOptions& options = {});

}  // namespace gaussmap
