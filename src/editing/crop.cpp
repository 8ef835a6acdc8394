// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/crop.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "map/child_links.h"
#include "map/coarsen.h"
#include "map/inherit_occupancy.h"
#include "map/map_scale_builder.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Which Gaussians of a scale are kept, and which of them lose a part of their points.
struct KeptGaussians {
  std::vector<char> is_kept, shrinks;
};

template <int D>
KeptGaussians keptGaussians(const GaussianMap<D>& map, int s, const KeptGaussians& finer,
                            const std::function<bool(const Vector<D>&)>& isInside) {
  const std::size_t count = map.gaussianCount(s);
  KeptGaussians own{std::vector<char>(count, false), std::vector<char>(count, false)};
  for (std::size_t i = 0; s > 0 && i < finer.is_kept.size(); ++i) {
    const std::size_t parent = map.parentOf(i, s - 1);
    own.is_kept[parent] |= finer.is_kept[i];
    own.shrinks[parent] |= !finer.is_kept[i] || finer.shrinks[i];
  }
  for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
    if (!map.isLeaf(cell, s)) continue;
    const IndexRange range = map.gaussiansOf(cell, s);
    for (std::size_t i = range.first; i < range.last; ++i) own.is_kept[i] = isInside(map.gaussian(i, s).mean);
  }
  return own;
}

/// Returns the kept Gaussians of a scale, without links. Sets `places` to the new index of each old Gaussian.
template <int D>
MapScale<D> cropped(const GaussianMap<D>& map, int s, const KeptGaussians& kept, std::vector<std::uint32_t>& places) {
  const MapScale<D>& old = map.scale(s);
  MapScaleBuilder<D> scale;
  places.assign(kept.is_kept.size(), 0);
  for (std::size_t cell = 0; cell < old.keys.size(); ++cell) {
    const IndexRange range = map.gaussiansOf(cell, s);
    bool is_first = true;
    for (std::size_t i = range.first; i < range.last; ++i) {
      if (!kept.is_kept[i]) continue;
      if (std::exchange(is_first, false)) scale.addCell(old.keys[cell]);
      places[i] = static_cast<std::uint32_t>(scale.gaussians());
      scale.copyGaussian(old, i);
    }
  }
  return scale.take();
}

/// Recomputes the clusters that lose points, as moment matches of their remaining children.
template <int D>
void matchShrunk(const GaussianMap<D>& map, int s, const KeptGaussians& kept, const std::vector<std::uint32_t>& places,
                 const MapScale<D>& finer, MapScale<D>& scale) {
  std::vector<char> shrinks(scale.gaussians.size(), false);
  for (std::size_t i = 0; i < kept.is_kept.size(); ++i)
    if (kept.is_kept[i]) shrinks[places[i]] = kept.shrinks[i];
  std::vector<Gaussian<D>> data;
  for (std::size_t cell = 0; cell < scale.keys.size(); ++cell) {
    const IndexRange children{scale.first_child[cell], scale.first_child[cell + 1]};
    if (children.empty()) continue;
    const IndexRange clusters = gaussiansOf(scale, cell);
    gatherUnder(finer, map.grid(), s - 1, children, data);
    const std::size_t first = gaussiansOf(finer, children.first).first;
    for (std::size_t i = clusters.first; i < clusters.last; ++i) {
      if (!shrinks[i]) continue;
      std::vector<Gaussian<D>> members;
      for (std::size_t j = 0; j < data.size(); ++j)
        if (finer.parent[first + j] == i) members.push_back(data[j]);
      scale.gaussians[i] = merge(members);
    }
  }
}

}  // namespace

template <int D>
GaussianMap<D> crop(const GaussianMap<D>& map, const std::function<bool(const Vector<D>&)>& isInside) {
  std::vector<MapScale<D>> scales;
  KeptGaussians finer;
  for (int s = 0; s < map.scales(); ++s) {
    KeptGaussians own = keptGaussians(map, s, finer, isInside);
    std::vector<std::uint32_t> places;
    MapScale<D> scale = cropped(map, s, own, places);
    if (s > 0) {
      MapScale<D>& below = scales.back();
      for (std::size_t i = 0; i < finer.is_kept.size(); ++i)
        if (finer.is_kept[i]) below.parent.push_back(places[map.parentOf(i, s - 1)]);
      scale.first_child = childLinks<D>(below.keys, scale.keys, map.grid(), s);
      matchShrunk(map, s, own, places, below, scale);
      inheritOccupancy<D>(below, scale);
    }
    scales.push_back(std::move(scale));
    finer = std::move(own);
  }
  return GaussianMap<D>(map.options(), std::move(scales));
}

Polygon::Polygon(std::vector<Vector<2>> corners) : corners_(std::move(corners)) {
  if (corners_.size() < 3)
    throw std::invalid_argument("a polygon needs at least three corners, found " + std::to_string(corners_.size()));
  for (std::size_t i = 0; i < corners_.size(); ++i)
    if (!corners_[i].allFinite())
      throw std::invalid_argument("corner " + std::to_string(i) + " of the polygon is not finite");
}

bool Polygon::contains(double x, double y) const {
  bool inside = false;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    // The lower end is always first. Two polygons that share a side then compute exactly the same for it.
    const Vector<2>*low = &corners_[i], *high = &corners_[(i + 1) % corners_.size()];
    if (low->y() > high->y()) std::swap(low, high);
    if (y < low->y() || y >= high->y()) continue;
    const Vector<2> along = *high - *low;
    if ((x - low->x()) * along.y() < (y - low->y()) * along.x()) inside = !inside;
  }
  return inside;
}

#define GAUSSMAP_INSTANTIATE(D) \
  template GaussianMap<D> crop<D>(const GaussianMap<D>&, const std::function<bool(const Vector<D>&)>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
