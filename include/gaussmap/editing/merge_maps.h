// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of mergeMaps().
struct MergeMapsOptions {
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair of clusters is merged next
  int threads = 0;                           ///< 0 = all cores
};

/// Merges two maps of the same frame into one, Yguel 2009 sec. 5.4. Merging with an empty map changes nothing.
///
/// Finest scale: If both maps hold exact moments (GaussianMap::acceptsScans()), the moments are added. The result is
/// then bit-identical to the finest scale of a map of all points, for any order of merging. If the coarse scales hold
/// one Gaussian per cell, they are identical as well. If one of the maps does not hold exact moments, the result holds
/// Gaussians instead. A cell that only one map has is copied. In a cell that both maps have, agglomerate() merges the
/// cheapest pairs of Gaussians. Let one map have p Gaussians in this cell and the other q; max(p, q) are left.
///
/// Coarse scales: A cell that only one map has keeps its clusters. In the cells that both maps have, agglomerate()
/// merges the cheapest pairs. At scale 1, the merging starts from the clusters of both maps. At coarser scales, it
/// starts from the Gaussians of the next finer scale. The number of clusters that are left is fixed for all these cells
/// together: it is the sum of max(p, q) over the cells. Every cluster is the exact moment match of its children.
///
/// The method of the paper differs from this function in three points. The paper fixes the number of clusters per cell,
/// starts from the clusters at every scale, and ends with a run of KLKMeans. Both methods were measured by merging two
/// halves of a drive. The error is the 95 % quantile of the distances from samples of the result to the points; it is
/// compared with the error of a map of all points. With the method of the paper, the error is 9 % larger at scale 1 and
/// 22 % larger at scale 2. With this function, it is 1 % smaller at scale 1 and 1 % larger at scale 2.
///
/// Occupancy: In a finest cell that both maps have, the log-odds are added and limited to +-kMaxOccupancy. If only one
/// map has occupancy, its log-odds are used, and the cells that exist only in the map without occupancy get
/// kMaxOccupancy. The log-odds of a coarse cluster are the maximum over its children.
///
/// mergeMaps(a, b) and mergeMaps(b, a) have a bit-identical finest scale.
///
/// Throws std::invalid_argument if the options of the maps differ (the message names the option), if a map is
/// compressed, or if a cell would hold 2^33 points or more. transformMap() resamples a map into another grid.
template <int D>
GAUSSMAP_API GaussianMap<D> mergeMaps(const GaussianMap<D>& a, const GaussianMap<D>& b,
                                      const MergeMapsOptions& options = {});

}  // namespace gaussmap
