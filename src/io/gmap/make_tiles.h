// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Which cells of a scale lie in which tile: runs of cells in key order.
template <int D>
std::map<CellKey<D>, std::vector<IndexRange>> cellsByTile(const MapScale<D>& scale, std::int32_t span);

/// A tile of these cells of scale s.
template <int D>
Tile<D> makeTile(const GaussianMap<D>& map, int s, const std::vector<IndexRange>& runs);

}  // namespace gaussmap::detail
