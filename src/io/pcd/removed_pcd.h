// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/mapping/online/online_mapper.h"

namespace gaussmap::detail {

/// Writes deleted clusters as a PCD file, so that a deletion can be looked at, explained and undone: x y z (doubles,
/// map frame) covariance[6] weight scale cell_x cell_y cell_z log_odds hits misses first_hit last_hit deleted_after
/// (numbers of scans, from 0) and, for clusters of exact sums, count sum[3] product[6] (CellMoments).
/// Throws FileError if it cannot be written.
void writeRemoved(const std::filesystem::path& path, const std::vector<RemovedCluster<3>>& removed);

/// Reads what writeRemoved wrote. Throws FileError if the file is no such cloud or a value is none.
std::vector<RemovedCluster<3>> readRemoved(const std::filesystem::path& path);

}  // namespace gaussmap::detail
