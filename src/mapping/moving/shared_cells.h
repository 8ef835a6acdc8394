// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/moving/moving_points.h"
#include "mapping/moving/surface.h"

namespace gaussmap::detail {

/// A finest cell in which or beside which an object was.
struct SharedCell {
  std::uint32_t first_scan, last_scan;  // first and last scan that may have seen the object in the cell
  std::optional<Surface<3>> surface = std::nullopt;
};
using SharedCells = std::unordered_map<std::size_t, SharedCell>;

/// Returns the cells of moving objects and the adjacent cells. `moving`, `evidence`: one entry per finest cell.
SharedCells findSharedCells(const GaussianMap<3>& map, const std::vector<bool>& moving,
                            const std::vector<Evidence>& evidence);

/// Fits the surface of each shared cell (surfaceAt()). Cells that are not shared contribute all their points. Shared
/// cells contribute `still`: the points that were measured while the object was elsewhere.
void fitSurfaces(const GaussianMap<3>& map, const MomentGrid<3>& still, const SharedCellOptions& options, int threads,
                 SharedCells& shared);

}  // namespace gaussmap::detail
