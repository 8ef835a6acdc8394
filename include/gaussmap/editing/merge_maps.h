// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The Gaussians from which mergeMaps() makes the coarse scales.
enum class MergeMethod {
  /// Scale 1 from the clusters of both maps, coarser scales from the Gaussians of the next finer scale of the result.
  /// The number of clusters is fixed for all cells together that both maps have at a scale. The cells where merges are
  /// expensive keep more of these clusters.
  FinerScales,
  /// From the clusters of both maps at the same scale, as in the paper. The number of clusters is fixed per cell. Only
  /// this method can merge compressed maps.
  Clusters,
};

/// Options of mergeMaps().
struct GAUSSMAP_API MergeMapsOptions {
  MergeCost merge_cost = MergeCost::Volume;       ///< which pair of clusters is merged next
  int threads = 0;                                ///< 0 = all cores
  MergeMethod method = MergeMethod::FinerScales;  ///< Gaussians from which the coarse scales are made
  bool smooth = false;  ///< ends with one run of KLKMeans per cell, which starts from the merged clusters

  /// Returns the options of the paper, Yguel 2009 sec. 5.4: MergeMethod::Clusters and MergeCost::KL, and then one run
  /// of the clustering per cell.
  ///
  /// Where the paper says nothing, this library decides. In a cell with more than AgglomerateOptions::max_exact
  /// clusters, only pairs of neighbours are compared. The run of the clustering ends after
  /// KLKMeansOptions::max_iterations at the latest. The paper does not mention the occupancy and the parents of merged
  /// clusters; mergeMaps() describes them.
  static MergeMapsOptions yguel2009();
};

/// Merges two maps of the same frame into one, Yguel 2009 sec. 5.4. Merging with an empty map changes nothing.
///
/// Finest scale: If both maps hold exact moments (GaussianMap::acceptsScans()), the moments are added. The result is
/// then bit-identical to the finest scale of a map of all points, for any order of merging. If the coarse scales hold
/// one Gaussian per cell, they are identical as well. If one of the maps does not hold exact moments, the result holds
/// Gaussians instead. A cell that only one map has is copied. In a cell that both maps have, agglomerate() merges the
/// cheapest pairs of Gaussians. If one map has p Gaussians in this cell and the other one has q, max(p, q) are left.
///
/// Coarse scales, MergeMethod::FinerScales: A cell that only one map has keeps its clusters. In the cells that both
/// maps have, agglomerate() merges the cheapest pairs. At scale 1, the merging starts from the clusters of both maps.
/// At coarser scales, it starts from the Gaussians of the next finer scale. The number of clusters that are left is
/// fixed for all these cells together: it is the sum of max(p, q) over the cells.
///
/// Coarse scales, MergeMethod::Clusters: In a cell that both maps have, the pair of clusters with the smallest cost is
/// replaced by its moment match, again and again, until max(p, q) clusters are left. No other scale is used. If a
/// coarse cell is a leaf of one of the maps (see compress()), it becomes a leaf of the result.
///
/// With MergeMapsOptions::smooth, one run of KLKMeans per cell follows. It starts from the merged clusters and assigns
/// the Gaussians that were merged to them again. The run can drop clusters.
///
/// Links: With MergeMethod::FinerScales, every cluster is the exact moment match of its children. With
/// MergeMethod::Clusters, every cluster is the exact moment match of the old clusters that it unites, and their
/// children become its children. The old parents of a merged finer cluster can belong to several merged clusters. It is
/// then linked to the one that gets the largest part of its weight. The other ones keep their Gaussians, but can have
/// fewer children or none.
///
/// docs/notes/merging.md compares both methods on two halves of a drive. There, MergeMapsOptions::yguel2009() is less
/// accurate than the default options. These are about as accurate as a map of all points.
///
/// Occupancy: In a finest cell that both maps have, the log-odds are added and limited to +-kMaxOccupancy. If only one
/// map has occupancy, its log-odds are used, and the cells that exist only in the map without occupancy get
/// kMaxOccupancy. The log-odds of a coarse cluster are the maximum over its children. With MergeMethod::Clusters, they
/// come from its old clusters instead: the maximum over those of each map, and the limited sum of the two maxima.
///
/// mergeMaps(a, b) and mergeMaps(b, a) have a bit-identical finest scale.
///
/// Throws std::invalid_argument if the options of the maps differ (the message names the option), if a map is
/// compressed (MergeMethod::FinerScales only), or if a cell would hold 2^33 points or more. transformMap() resamples a
/// map into another grid.
template <int D>
GAUSSMAP_API GaussianMap<D> mergeMaps(const GaussianMap<D>& a, const GaussianMap<D>& b,
                                      const MergeMapsOptions& options = {});

}  // namespace gaussmap
