// SPDX-License-Identifier: BSD-3-Clause
#include "map/in_space.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace gaussmap::detail {

GaussianMap<3> inSpace(const GaussianMap<2>& map) {
  if (map.empty()) return GaussianMap<3>(map.options());
  std::vector<MapScale<3>> scales;
  for (int s = 0; s < map.scales(); ++s) {
    const MapScale<2>& from = map.scale(s);
    MapScale<3> scale;
    scale.keys.reserve(from.keys.size());
    for (const CellKey<2>& key : from.keys) scale.keys.push_back({key[0], key[1], 0});
    scale.first_child = from.first_child;
    scale.first_gaussian = from.first_gaussian;
    scale.parent = from.parent;
    scale.log_odds = from.log_odds;
    scale.gaussians.reserve(map.gaussianCount(s));
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i) {
      scale.gaussians.push_back(inSpace(map.localGaussian(i, s), map.options().noise));
      scale.gaussians.back().mean.z() = -0.5 * map.grid().side(s);  // about the centre of the cell
    }
    scales.push_back(std::move(scale));
  }
  return GaussianMap<3>(map.options(), std::move(scales));
}

}  // namespace gaussmap::detail
