// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "mapping/moving/surface.h"

namespace gaussmap::detail {

/// The finest cells that an object was in or beside, while scans first ... last saw it, and the surface there.
struct SharedCell {
  std::uint32_t first_scan, last_scan;
  std::optional<Surface<3>> surface = std::nullopt;
};
using SharedCells = std::unordered_map<std::size_t, SharedCell>;

/// The cells of moving objects and their neighbours.
SharedCells findSharedCells(const GaussianMap<3>& map, const std::vector<bool>& moving,
                            const std::vector<Evidence>& evidence);

/// Fits the surfaces: from the points in cells that neither hold nor touch an object, and from `still`, the points of
/// the cells beside one that were measured while it was elsewhere; the nearest cells that make a flat piece.
void fitSurfaces(const GaussianMap<3>& map, const MomentGrid<3>& still, const SharedCellOptions& options, int threads,
                 SharedCells& shared);

}  // namespace gaussmap::detail
