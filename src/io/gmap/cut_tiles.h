// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Which cells of a scale lie in which tile: runs of cells in key order.
template <int D>
std::map<CellKey<D>, std::vector<IndexRange>> tilesOf(const MapScale<D>& scale, std::int32_t span);

/// These cells of scale s as a tile.
template <int D>
Tile<D> cutTile(const GaussianMap<D>& map, int s, const std::vector<IndexRange>& runs);

}  // namespace gaussmap::detail
