// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/make_tiles.h"

#include "io/gmap/map_schema.h"

namespace gaussmap::detail {

template <int D>
std::map<CellKey<D>, std::vector<IndexRange>> cellsByTile(const MapScale<D>& scale, std::int32_t span) {
  std::map<CellKey<D>, std::vector<IndexRange>> tiles;
  for (std::size_t cell = 0; cell < scale.keys.size(); ++cell) {
    std::vector<IndexRange>& runs = tiles[tileOf<D>(scale.keys[cell], span)];
    if (!runs.empty() && runs.back().last == cell)
      ++runs.back().last;
    else
      runs.push_back({cell, cell + 1});
  }
  return tiles;
}

template <int D>
Tile<D> makeTile(const GaussianMap<D>& map, int s, const std::vector<IndexRange>& runs) {
  const MapScale<D>& scale = map.scale(s);
  Tile<D> tile;
  for (const IndexRange& run : runs)
    for (std::size_t cell = run.first; cell < run.last; ++cell) {
      const IndexRange range = map.gaussiansOf(cell, s);
      tile.keys.push_back(scale.keys[cell]);
      tile.counts.push_back(static_cast<std::uint32_t>(range.size()));
      if (!scale.moments.empty()) tile.moments.push_back(scale.moments[cell]);
      for (std::size_t i = range.first; i < range.last; ++i) {
        if (scale.moments.empty()) tile.gaussians.push_back(scale.gaussians[i]);
        if (map.hasOccupancy()) tile.log_odds.push_back(scale.log_odds[i]);
        if (s + 1 == map.scales()) continue;
        const std::size_t parent = scale.parent[i];
        const std::size_t first = map.gaussiansOf(map.cellOf(parent, s + 1), s + 1).first;
        tile.labels.push_back(static_cast<std::uint32_t>(parent - first));
      }
    }
  return tile;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                            \
  template std::map<CellKey<D>, std::vector<IndexRange>> cellsByTile<D>(const MapScale<D>&, std::int32_t); \
  template Tile<D> makeTile<D>(const GaussianMap<D>&, int, const std::vector<IndexRange>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
