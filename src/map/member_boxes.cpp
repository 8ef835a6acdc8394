// SPDX-License-Identifier: BSD-3-Clause
#include "map/member_boxes.h"

#include <cmath>
#include <limits>

#include "map/parent_boxes.h"

namespace gaussmap::detail {

template <int D>
std::vector<Box<D>> parentBoxes(const std::vector<Box<D>>& members, const std::vector<std::uint32_t>& parent,
                                std::size_t count) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<Box<D>> boxes(count, {Vector<D>::Constant(kFar), Vector<D>::Constant(-kFar)});
  for (std::size_t i = 0; i < members.size(); ++i) {
    Box<D>& box = boxes[parent[i]];
    box.low = box.low.cwiseMin(members[i].low);
    box.high = box.high.cwiseMax(members[i].high);
  }
  return boxes;
}

template <int D>
std::vector<Box<D>> memberBoxes(const GaussianMap<D>& map, int scale) {
  std::vector<Box<D>> boxes;
  for (int s = 0; s <= scale; ++s) {
    boxes =
        parentBoxes<D>(boxes, s == 0 ? std::vector<std::uint32_t>() : map.scale(s - 1).parent, map.gaussianCount(s));
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      const IndexRange range = map.gaussiansOf(cell, s);
      for (std::size_t i = range.first; i < range.last; ++i)
        if (std::isinf(boxes[i].low(0))) boxes[i] = map.grid().boxOf(map.scale(s).keys[cell], s);
    }
  }
  return boxes;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                  \
  template std::vector<Box<(D)>> parentBoxes<D>(const std::vector<Box<(D)>>&, const std::vector<std::uint32_t>&, \
                                                std::size_t);                                                    \
  template std::vector<Box<(D)>> memberBoxes<D>(const GaussianMap<D>&, int);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
