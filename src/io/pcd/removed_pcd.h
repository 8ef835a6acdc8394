// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Writes deleted clusters as a PCD file, so that a user can inspect, explain and undo a deletion.
///
/// Fields: x y z (doubles, map frame) covariance[6] weight scale cell_x cell_y cell_z log_odds hits misses first_hit
/// last_hit deleted_after, then count sum[3] product[6]. first_hit, last_hit and deleted_after are numbers of scans,
/// counted from 0. The last three fields are the CellMoments; they are 0 if the cluster has no exact moments. Clusters
/// of a planar map (D = 2) lie in the plane z = 0. Their variance across the plane is their smaller variance in it.
/// Throws FileError if the file cannot be written.
template <int D = 3>
GAUSSMAP_API void writeRemoved(const std::filesystem::path& path, const std::vector<RemovedCluster<D>>& removed);

/// Reads a file of writeRemoved(). Throws FileError if a field is missing or has the wrong type, or if a value is
/// impossible or not finite. For D = 2, it also throws FileError if a cluster does not lie in the plane z = 0.
template <int D = 3>
GAUSSMAP_API std::vector<RemovedCluster<D>> readRemoved(const std::filesystem::path& path);

}  // namespace gaussmap::detail
