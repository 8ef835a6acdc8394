// SPDX-License-Identifier: BSD-3-Clause
#include "editing/keep_cells.h"

#include <cstdint>
#include <utility>

#include "map/map_scale_builder.h"

namespace gaussmap::detail {
namespace {

/// Returns the kept cells of a scale, without children. `places` = new indices of the Gaussians of the next coarser
/// scale; on return, new indices of the Gaussians of this scale.
template <int D>
MapScale<D> keepCellsOfScale(const GaussianMap<D>& map, int s, const std::vector<char>& keep,
                             std::vector<std::uint32_t>& places) {
  const MapScale<D>& old = map.scale(s);
  MapScaleBuilder<D> thin;
  std::vector<std::uint32_t> own_places(map.gaussianCount(s), 0);
  for (std::size_t cell = 0; cell < old.keys.size(); ++cell) {
    if (!keep[cell]) continue;
    const IndexRange range = map.gaussiansOf(cell, s);
    for (std::size_t i = range.first; i < range.last; ++i) {
      own_places[i] = static_cast<std::uint32_t>(thin.gaussians() + (i - range.first));
      if (!old.parent.empty()) thin.addParent(places[old.parent[i]]);
    }
    thin.copyCell(old, cell);
  }
  places = std::move(own_places);
  return thin.take();
}

/// Returns MapScale::first_child of the kept cells.
template <int D>
std::vector<std::uint32_t> keptChildren(const GaussianMap<D>& map, int s, const std::vector<char>& keep,
                                        const std::vector<char>& keep_finer) {
  std::vector<std::uint32_t> first_child = {0};
  for (std::size_t cell = 0; cell < keep.size(); ++cell) {
    if (!keep[cell]) continue;
    const IndexRange children = map.childCells(cell, s);
    std::uint32_t count = first_child.back();
    for (std::size_t child = children.first; child < children.last; ++child) count += keep_finer[child] ? 1 : 0;
    first_child.push_back(count);
  }
  return first_child;
}

}  // namespace

template <int D>
GaussianMap<D> keepCells(const GaussianMap<D>& map, const std::vector<std::vector<char>>& keep) {
  std::vector<MapScale<D>> scales(keep.size());
  std::vector<std::uint32_t> places;
  for (int s = map.scales() - 1; s >= 0; --s) {
    const auto at = static_cast<std::size_t>(s);
    scales[at] = keepCellsOfScale<D>(map, s, keep[at], places);
    if (s > 0) scales[at].first_child = keptChildren<D>(map, s, keep[at], keep[at - 1]);
  }
  return GaussianMap<D>(map.options(), std::move(scales));
}

template GaussianMap<2> keepCells<2>(const GaussianMap<2>&, const std::vector<std::vector<char>>&);
template GaussianMap<3> keepCells<3>(const GaussianMap<3>&, const std::vector<std::vector<char>>&);

}  // namespace gaussmap::detail
