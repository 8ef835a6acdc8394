// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

struct RefineOptions {
  double budget = 3.0;  ///< most Gaussians of a coarse scale, as a multiple of its occupied cells, >= 1 (1: one a cell)
  int queue = 0;        ///< p, cells refined at a time, >= 1; 0: cells / 250, at least 4 (the paper's p)
  int max_swaps = 20;   ///< most rounds of the swap loop per inserted cluster, >= 0
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;
  WorstDatum worst_rule = WorstDatum::Distance;
  std::uint64_t seed = 0;  ///< same map + same seed = same bytes, at any number of threads
  int threads = 0;         ///< 0 = all
};

/// Adds clusters where the coarse scales stand badly for the finer ones, Yguel 2009 sec. 5. The result depends on the
/// finest scale only: from the finest to the coarsest, every coarse scale is made anew by coarsen(); then, as long as
/// its budget of floor(budget * cells) Gaussians lasts, the p cells of largest error (cellError(), eq. (6)) get one
/// more cluster each (insertCluster(), Algorithm 2) and return to the queue with their new error. A cell leaves the
/// queue when it has a cluster for every finer Gaussian, its error is 0, or its data allow no more clusters.
/// Every cluster is the moment match of the finer Gaussians whose `parent` it is, so that the total weight of a scale
/// stays the number of points. The finest scale stays as it is.
/// Throws std::invalid_argument, naming the option.
template <int D>
GaussianMap<D> refine(GaussianMap<D> map, const RefineOptions& options = {});

}  // namespace gaussmap
