// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Appends the cells of a tile to others of the same scale.
template <int D>
void appendTile(Tile<D>& all, const Tile<D>& tile);

/// The cells of a tile that keep(key) wants, behind those of `out`.
template <int D, typename Keep>
void appendCells(Tile<D>& out, const Tile<D>& tile, const Keep& keep) {
  std::size_t first = 0;
  for (std::size_t cell = 0; cell < tile.keys.size(); ++cell) {
    const std::size_t last = first + tile.counts[cell];
    if (keep(tile.keys[cell])) {
      const auto append = [&](auto& to, const auto& from) {
        if (from.empty()) return;
        to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(first),
                  from.begin() + static_cast<std::ptrdiff_t>(last));
      };
      out.keys.push_back(tile.keys[cell]);
      out.counts.push_back(tile.counts[cell]);
      append(out.moments, tile.moments);  // one a cell, as then are Gaussians
      append(out.gaussians, tile.gaussians);
      append(out.labels, tile.labels);
      append(out.log_odds, tile.log_odds);
    }
    first = last;
  }
}

/// The map made of these cells, one list a scale, finest first, each in any order: puts them into key order, finds
/// children and turns labels into parents. Throws std::invalid_argument, saying what, if they do not fit together.
template <int D>
GaussianMap<D> assembleMap(const MapOptions& options, std::vector<Tile<D>> scales);

}  // namespace gaussmap::detail
