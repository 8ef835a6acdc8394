// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "commands/hausdorff/hausdorff.h"

namespace gaussmap::app {

std::string textOf(const Level& level) {
  return level ? std::to_string(*level) : "leaves";
}

Json jsonOf(const Level& level) {
  return level ? Json(*level) : Json("leaves");
}

std::vector<Level> chosenLevels(const HausdorffCommand& command, const std::vector<const GaussianMap<3>*>& maps) {
  if (command.leaves) return {std::nullopt};
  int scales = maps.front()->scales();
  bool compressed = false;
  for (const GaussianMap<3>* map : maps) {
    scales = std::min(scales, map->scales());
    compressed |= map->isCompressed();
  }
  if (command.scale) {
    checkScale("--scale", *command.scale, scales);
    return {command.scale};
  }
  std::vector<Level> levels;
  if (compressed) levels.push_back(std::nullopt);
  for (int s = 0; s < scales; ++s)
    if (!compressed || std::all_of(maps.begin(), maps.end(), [&](auto* map) { return map->cellCount(s) > 0; }))
      levels.emplace_back(s);
  return levels;
}

}  // namespace gaussmap::app
