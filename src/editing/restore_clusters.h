// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// A map after deleted clusters were restored.
template <int D>
struct RestoredMap {
  GaussianMap<D> map;
  std::size_t clusters = 0;  ///< number of restored clusters of the finest scale
  std::int64_t points = 0;   ///< number of points of these clusters
};

/// Restores the clusters that OnlineMapper has deleted and whose mean lies inside: isInside(mean) [m, map frame]. The
/// moments of the finest scale are exact. The coarse scales are rebuilt with their old numbers of Gaussians, but at
/// least one per cell. If the map has occupancy, cells with restored points get kMaxOccupancy.
/// `threads`: 0 = all cores.
///
/// Throws std::invalid_argument if the map has no moments. Also throws it if a cluster has no moments, is from a map of
/// another resolution, or could give a cell more points than CellMoments::kMaxPoints.
template <int D>
GAUSSMAP_API RestoredMap<D> restoreClusters(const GaussianMap<D>& map, const std::vector<RemovedCluster<D>>& removed,
                                            const std::function<bool(const Vector<D>&)>& isInside, int threads = 0);

}  // namespace gaussmap::detail
