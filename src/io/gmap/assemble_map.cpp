// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/assemble_map.h"

#include <cstdint>
#include <stdexcept>
#include <utility>

#include "map/child_links.h"
#include "map/map_scale_builder.h"

namespace gaussmap::detail {
namespace {

template <int D>
struct OrderedScale {
  MapScale<D> scale;
  std::vector<std::uint32_t> labels;
};

/// Sorts the cells of a scale into key order.
template <int D>
OrderedScale<D> inKeyOrder(const Tile<D>& tile, const MapOptions& options, int s) {
  std::vector<std::size_t> first(tile.keys.size() + 1, 0);
  for (std::size_t i = 0; i < tile.counts.size(); ++i) first[i + 1] = first[i] + tile.counts[i];
  const bool one_per_cell = tile.moments.size() == tile.keys.size() && first.back() == tile.keys.size();
  if (!tile.moments.empty() && (!one_per_cell || !tile.gaussians.empty()))
    throw std::invalid_argument("some cells hold moments and some do not");
  if (!tile.log_odds.empty() && tile.log_odds.size() != first.back())
    throw std::invalid_argument("some cells hold an occupancy and some do not");
  MapScaleBuilder<D> scale;
  std::vector<std::uint32_t> labels;
  for (const std::uint32_t from : keyOrder<D>(tile.keys, options.ratio, options.scales - 1 - s)) {
    scale.addCell(tile.keys[from]);
    if (!tile.moments.empty()) scale.addMoments(tile.moments[from]);
    for (std::size_t i = first[from]; i < first[from + 1]; ++i) {
      if (!tile.gaussians.empty()) scale.addGaussian(tile.gaussians[i]);
      if (!tile.log_odds.empty()) scale.addLogOdds(tile.log_odds[i]);
      if (s + 1 == options.scales) continue;
      if (i >= tile.labels.size()) throw std::invalid_argument("a Gaussian has no parent");
      labels.push_back(tile.labels[i]);
    }
  }
  return {scale.take(), std::move(labels)};
}

/// Finds the children of every cell and computes the parents of the Gaussians from their labels.
template <int D>
void link(MapScale<D>& finer, const std::vector<std::uint32_t>& labels, MapScale<D>& coarse, const Grid<D>& grid,
          int s) {
  coarse.first_child = childLinks<D>(finer.keys, coarse.keys, grid, s);
  const auto startOf = [](const std::vector<std::uint32_t>& first_gaussian, std::size_t cell) {
    return first_gaussian.empty() ? cell : std::size_t{first_gaussian[cell]};
  };
  finer.parent.reserve(labels.size());
  for (std::size_t cell = 0; cell < coarse.keys.size(); ++cell) {
    const std::size_t first = startOf(coarse.first_gaussian, cell);
    const std::size_t last = startOf(finer.first_gaussian, coarse.first_child[cell + 1]);
    while (finer.parent.size() < last)
      finer.parent.push_back(static_cast<std::uint32_t>(first + labels[finer.parent.size()]));
  }
}

}  // namespace

template <int D>
void appendTile(Tile<D>& all, const Tile<D>& tile) {
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(all.keys, tile.keys);
  append(all.counts, tile.counts);
  append(all.moments, tile.moments);
  append(all.gaussians, tile.gaussians);
  append(all.labels, tile.labels);
  append(all.log_odds, tile.log_odds);
}

template <int D>
GaussianMap<D> assembleMap(const MapOptions& options, std::vector<Tile<D>> tiles) {
  const Grid<D> grid(options);
  std::vector<MapScale<D>> scales(tiles.size());
  for (std::size_t s = tiles.size(); s-- > 0;) {
    OrderedScale<D> ordered = inKeyOrder<D>(tiles[s], options, static_cast<int>(s));
    tiles[s] = {};  // frees memory: large maps do not fit twice
    scales[s] = std::move(ordered.scale);
    if (s + 1 < tiles.size()) link<D>(scales[s], ordered.labels, scales[s + 1], grid, static_cast<int>(s) + 1);
  }
  return GaussianMap<D>(options, std::move(scales));
}

#define GAUSSMAP_INSTANTIATE(D)                          \
  template void appendTile<D>(Tile<D>&, const Tile<D>&); \
  template GaussianMap<D> assembleMap<D>(const MapOptions&, std::vector<Tile<(D)>>);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
