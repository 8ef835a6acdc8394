// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/leaves.h"

#include <stdexcept>
#include <string>

namespace gaussmap {
namespace {

/// Calls visit(index) for every Gaussian of a scale that stands in a leaf.
template <int D, typename Visit>
void forEachLeaf(const GaussianMap<D>& map, int scale, const Visit& visit) {
  for (std::size_t cell = 0; cell < map.cellCount(scale); ++cell) {
    if (!map.isLeaf(cell, scale)) continue;
    const IndexRange range = map.gaussiansOf(cell, scale);
    for (std::size_t i = range.first; i < range.last; ++i) visit(i);
  }
}

}  // namespace

template <int D>
std::vector<GaussianId> gaussiansOfScale(const GaussianMap<D>& map, int scale) {
  if (scale < 0 || scale >= map.scales())
    throw std::out_of_range("scale " + std::to_string(scale) + ": the map has " + std::to_string(map.scales()));
  std::vector<GaussianId> all(map.gaussianCount(scale));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = {scale, i};
  return all;
}

template <int D>
std::vector<GaussianId> leaves(const GaussianMap<D>& map) {
  std::vector<GaussianId> found;
  for (int s = 0; s < map.scales(); ++s) forEachLeaf(map, s, [&](std::size_t i) { found.push_back({s, i}); });
  return found;
}

template <int D>
LeafCounts leafCounts(const GaussianMap<D>& map, int scale) {
  LeafCounts counts;
  for (std::size_t cell = 0; cell < map.cellCount(scale); ++cell) counts.cells += map.isLeaf(cell, scale) ? 1 : 0;
  forEachLeaf(map, scale, [&](std::size_t i) {
    ++counts.gaussians;
    counts.weight += map.localGaussian(i, scale).weight;
  });
  return counts;
}

#define GAUSSMAP_INSTANTIATE(D)                                                     \
  template std::vector<GaussianId> gaussiansOfScale<D>(const GaussianMap<D>&, int); \
  template std::vector<GaussianId> leaves<D>(const GaussianMap<D>&);                \
  template LeafCounts leafCounts<D>(const GaussianMap<D>&, int);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
