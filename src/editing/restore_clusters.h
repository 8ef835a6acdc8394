// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// A map with deleted clusters in it again.
struct RestoredMap {
  GaussianMap<3> map;
  std::size_t clusters = 0;  ///< of the finest scale, brought back
  std::int64_t points = 0;   ///< of these clusters
};

/// Brings clusters back that OnlineMapper has deleted and whose mean (map frame) is inside. The finest scale is exact;
/// the coarse scales are rebuilt with as many Gaussians as they have, but at least one per cell. Cells that a cluster
/// came back to are certainly occupied (kMaxOccupancy). `threads`: 0 = all cores.
/// Throws std::invalid_argument if the map has no moments, or if a cluster has none, is from a map of another
/// resolution, or would make a cell overflow.
GAUSSMAP_API RestoredMap restoreClusters(const GaussianMap<3>& map, const std::vector<RemovedCluster<3>>& removed,
                                         const std::function<bool(const Vector<3>&)>& isInside, int threads = 0);

}  // namespace gaussmap::detail
