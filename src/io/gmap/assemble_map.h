// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Appends the cells of a tile to other cells of the same scale.
template <int D>
void appendTile(Tile<D>& all, const Tile<D>& tile);

/// Appends to `out` the cells of a tile for which keep(key) is true.
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
      append(out.moments, tile.moments);  // a tile with moments has one Gaussian per cell
      append(out.gaussians, tile.gaussians);
      append(out.labels, tile.labels);
      append(out.log_odds, tile.log_odds);
    }
    first = last;
  }
}

/// Builds a map from cells: one list per scale, finest first, in any order. It sorts the cells into key order, finds
/// the children, and computes the parents from the labels. Throws std::invalid_argument with the reason if the cells do
/// not fit together.
template <int D>
GaussianMap<D> assembleMap(const MapOptions& options, std::vector<Tile<D>> scales);

}  // namespace gaussmap::detail
