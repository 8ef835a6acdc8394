// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Returns the cells of each tile of a scale, as ranges of cells in key order.
template <int D>
std::map<CellKey<D>, std::vector<IndexRange>> cellsByTile(const MapScale<D>& scale, std::int32_t span);

/// Returns a tile of these cells of scale s.
template <int D>
Tile<D> makeTile(const GaussianMap<D>& map, int s, const std::vector<IndexRange>& runs);

}  // namespace gaussmap::detail
