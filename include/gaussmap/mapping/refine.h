// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

enum class RefineMethod {
  Agglomerate,  ///< bottom-up: from all finer Gaussians, merged where it costs least (agglomerate())
  Insert,       ///< top-down, as in the paper: from one Gaussian a cell, one more where the error is (insertCluster())
};

/// Which cells RefineMethod::Insert gives the next cluster to.
enum class CellChoice {
  Error,   ///< of largest error [6], as in the paper
  Volume,  ///< of largest summed volume of ellipsoids, sum of sqrt(det Sigma)
};

struct RefineOptions {
  double budget = 3.0;  ///< most Gaussians of a coarse scale, as a multiple of its occupied cells, >= 1 (1: one a cell)
  std::map<int, std::size_t> max_gaussians;  ///< most Gaussians of a coarse scale, by scale, in place of the budget
  RefineMethod method = RefineMethod::Agglomerate;
  MergeCost merge_cost = MergeCost::Volume;  ///< Agglomerate only
  // Insert only:
  CellChoice cell_choice = CellChoice::Error;
  int queue = 0;       ///< p, cells refined at a time, >= 1; 0: cells / 250, at least 4 (the paper's p)
  int max_swaps = 20;  ///< most rounds of the swap loop per inserted cluster, >= 0
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;
  WorstDatum worst_rule = WorstDatum::Distance;
  std::uint64_t seed = 0;  ///< same map + same seed = same bytes, at any number of threads
  // Both:
  int threads = 0;  ///< 0 = all
};

/// Gives the coarse scales more Gaussians where one a cell stands badly for the finer ones. The result depends on the
/// finest scale only: from the finest to the coarsest, every coarse scale is made anew and gets
/// floor(budget * cells) Gaussians (one per finer Gaussian at most).
///
/// Agglomerate: the finer Gaussians z_j under a cell, blurred by half a finest cell, weighted by the number of
/// occupied finest cells that they stand for, are merged to a dendrogram (agglomerate()). From the top of all
/// dendrograms of the scale, the merges that cost most are undone, until the budget is used. No random numbers.
///
/// Insert, Yguel 2009 sec. 5: as long as the budget lasts, the p cells of largest error (cellError(), eq. (6)) get one
/// more cluster each (insertCluster(), Algorithm 2) and return to the queue with their new error. A cell leaves the
/// queue when it has a cluster for every finer Gaussian, its error is 0, or its data allow no more clusters; then
/// less than the budget is used.
///
/// Every cluster is the moment match (weights = numbers of points) of the finer Gaussians whose `parent` it is, so that
/// the total weight of a scale stays the number of points. The finest scale stays as it is.
/// Throws std::invalid_argument, naming the option, and for a compressed map.
template <int D>
GaussianMap<D> refine(GaussianMap<D> map, const RefineOptions& options = {});

}  // namespace gaussmap
