// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <stdexcept>

#include "commands/hausdorff/hausdorff.h"

namespace gaussmap::app {

std::string textOf(const Level& level) {
  return level ? std::to_string(*level) : "leaves";
}

Json jsonOf(const Level& level) {
  return level ? Json(*level) : Json("leaves");
}

template <int D>
std::vector<Level> chosenLevels(const HausdorffCommand& command, const std::vector<const GaussianMap<D>*>& maps) {
  if (command.leaves) return {std::nullopt};
  int scales = maps.front()->scales();
  bool compressed = false;
  for (const GaussianMap<D>* map : maps) {
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
template std::vector<Level> chosenLevels(const HausdorffCommand&, const std::vector<const GaussianMap<2>*>&);
template std::vector<Level> chosenLevels(const HausdorffCommand&, const std::vector<const GaussianMap<3>*>&);

template <int D>
std::vector<Vector<D>> readReference(const HausdorffCommand& command, double resolution) {
  const int threads = command.samples.threads;
  if constexpr (D == 3) {
    if (!command.slice.empty()) throw UsageError("--slice: only for planar maps; use --crop with heights");
    return readPoints(command.reference, threads, resolution);
  } else {
    const AccumulateOptions limits =
        withSlice(accumulateOptions(command.reference, 1.0, threads), command.slice, command.reference.crop);
    const FileScans scans = openScans(command.reference, threads);
    std::vector<Vector<D>> points = readChecked<D>(
        scans, command.slice, [&](const Scans& checked) { return gaussmap::readPoints<D>(checked, limits); });
    warnOfCoordinates(scans, resolution);
    if (points.empty()) throw std::runtime_error(nameOf(scans) + ": no point is usable");
    return points;
  }
}
template std::vector<Vector<2>> readReference<2>(const HausdorffCommand&, double);
template std::vector<Vector<3>> readReference<3>(const HausdorffCommand&, double);

}  // namespace gaussmap::app
