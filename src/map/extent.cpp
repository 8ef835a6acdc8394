// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/extent.h"

#include <algorithm>

namespace gaussmap {

template <int D>
std::optional<Box<D>> extentOf(const GaussianMap<D>& map) {
  if (map.empty()) return std::nullopt;
  const std::vector<CellKey<D>>& keys = map.scale(0).keys;
  CellKey<D> low = keys.front(), high = keys.front();
  for (const CellKey<D>& key : keys)
    for (std::size_t axis = 0; axis < D; ++axis) {
      low[axis] = std::min(low[axis], key[axis]);
      high[axis] = std::max(high[axis], key[axis]);
    }
  const double half = 0.5 * map.grid().side(0);
  return Box<D>{(map.grid().centre(low, 0).array() - half).matrix(),
                (map.grid().centre(high, 0).array() + half).matrix()};
}

template std::optional<Box<2>> extentOf<2>(const GaussianMap<2>&);
template std::optional<Box<3>> extentOf<3>(const GaussianMap<3>&);

}  // namespace gaussmap
