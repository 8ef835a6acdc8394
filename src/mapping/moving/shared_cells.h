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

/// A finest cell that an object was in or beside.
struct SharedCell {
  std::uint32_t first_scan, last_scan;  // that may have seen the object in it
  std::optional<Surface<3>> surface = std::nullopt;
};
using SharedCells = std::unordered_map<std::size_t, SharedCell>;

/// The cells of moving objects and their neighbours.
SharedCells findSharedCells(const GaussianMap<3>& map, const std::vector<bool>& moving,
                            const std::vector<Evidence>& evidence);

/// Fits the surfaces (surfaceAt()) to the points in cells that neither hold nor touch an object, and to `still`: the
/// points of shared cells that were measured while the object was elsewhere.
void fitSurfaces(const GaussianMap<3>& map, const MomentGrid<3>& still, const SharedCellOptions& options, int threads,
                 SharedCells& shared);

}  // namespace gaussmap::detail
