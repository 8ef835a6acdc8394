// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/member_boxes.h"

#include <limits>

namespace gaussmap {

template <int D>
std::vector<Box<D>> memberBoxes(const GaussianMap<D>& map, int scale) {
  std::vector<Box<D>> boxes(map.gaussianCount(0));
  const double half = 0.5 * map.grid().side(0);
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    const Vector<D> centre = map.grid().centre(map.scale(0).keys[cell], 0);
    const IndexRange range = map.gaussiansOf(cell, 0);
    for (std::size_t i = range.first; i < range.last; ++i)
      boxes[i] = {(centre.array() - half).matrix(), (centre.array() + half).matrix()};
  }
  for (int s = 0; s < scale; ++s) {
    const double far = std::numeric_limits<double>::infinity();
    std::vector<Box<D>> coarser(map.gaussianCount(s + 1), {Vector<D>::Constant(far), Vector<D>::Constant(-far)});
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      Box<D>& box = coarser[map.parentOf(i, s)];
      box.low = box.low.cwiseMin(boxes[i].low);
      box.high = box.high.cwiseMax(boxes[i].high);
    }
    boxes = std::move(coarser);
  }
  return boxes;
}

template std::vector<Box<2>> memberBoxes<2>(const GaussianMap<2>&, int);
template std::vector<Box<3>> memberBoxes<3>(const GaussianMap<3>&, int);

}  // namespace gaussmap
