// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct MergeMapsOptions {
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair of clusters is the closest
  int threads = 0;                           ///< 0 = all; never shows in the result
};

/// One map of two in the same frame, Yguel 2009 sec. 5.4. An empty map changes nothing.
///
/// Finest scale. Where both maps hold exact moments (acceptsScans()) these add, so that maps of parts of the points
/// give the finest scale of the map of all of them to the last bit, in any order, and the coarse scales too as long as
/// they hold one Gaussian a cell. Else the result holds Gaussians: those of cells that only one map has, as they are,
/// and in cells of both the moment matches of the closest, as many as the map with more of them has there.
///
/// Coarse scales. Cells of one map alone keep their clusters. In cells of both, all their clusters of scale 1, and at
/// coarser scales the Gaussians below, are merged two by two (agglomerate()) where it costs least, until as many are
/// left as the map with more of them had there, counted over all such cells together. Every cluster is the exact moment
/// match of the finer Gaussians linked to it. The paper counts cell by cell, starts from the clusters at every scale,
/// and ends with a run of KLKMeans: samples of the two halves of a drive were then 9 % (scale 1) and 22 % (scale 2)
/// farther from the points (95 %) than those of a map built at once, now they are nearer by 1 % and farther by 1 %.
///
/// Occupancy. Log-odds of a finest cell add, bounded by kMaxOccupancy; a map that was asked nothing adds nothing where
/// the other was, and cells that only it has are certain. Coarse clusters are as occupied as the most occupied finer.
///
/// mergeMaps(a, b) and mergeMaps(b, a) have the same finest scale to the last bit.
/// Throws std::invalid_argument, naming the option, if the options differ (transformMap() makes one map fit the other);
/// if a map is compressed: what it does not have cannot be merged; and if a cell would hold 2^33 points or more.
template <int D>
GAUSSMAP_API GaussianMap<D> mergeMaps(const GaussianMap<D>& a, const GaussianMap<D>& b,
                                      const MergeMapsOptions& options = {});

}  // namespace gaussmap
