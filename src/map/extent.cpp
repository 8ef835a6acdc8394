// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/extent.h"

namespace gaussmap {

template <int D>
std::optional<Box<D>> extentOf(const GaussianMap<D>& map) {
  std::optional<Box<D>> extent;
  for (int s = 0; s < map.scales(); ++s) {
    const double half = 0.5 * map.grid().side(s);
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      if (!map.isLeaf(cell, s)) continue;
      const Vector<D> centre = map.grid().centre(map.scale(s).keys[cell], s);
      const Box<D> box{(centre.array() - half).matrix(), (centre.array() + half).matrix()};
      extent = extent ? Box<D>{extent->low.cwiseMin(box.low), extent->high.cwiseMax(box.high)} : box;
    }
  }
  return extent;
}

template std::optional<Box<2>> extentOf<2>(const GaussianMap<2>&);
template std::optional<Box<3>> extentOf<3>(const GaussianMap<3>&);

}  // namespace gaussmap
