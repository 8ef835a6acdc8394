// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "commands/hausdorff/hausdorff.h"
#include "gaussmap/map/queries.h"

namespace gaussmap::app {

template <int D>
void scoreMap(const HausdorffCommand& command) {
  const std::vector<Vector<D>> points = readReference<D>(command, MapOptions().resolution);
  const GaussianMap<D> map = loadMap<D>(command.subject);
  HeldOutOptions scoring = command.scoring;
  scoring.threads = command.samples.threads;
  Json all = Json::array();
  if (!command.json)
    std::printf("%-6s %10s %10s %10s %10s %10s %10s %10s\n", "scale", "gaussians", "mean", "median", "floor", "no cell",
                "nowhere", "points");
  for (const Level& level : chosenLevels<D>(command, {&map})) {
    const HeldOutResult result =
        level ? heldOutLogLikelihood<D>(map, *level, points, scoring) : heldOutLogLikelihood<D>(map, points, scoring);
    const std::size_t gaussians = level ? map.gaussianCount(*level) : leaves<D>(map).size();
    const double share = 1.0 / static_cast<double>(result.count);
    const double in_no_cell = share * static_cast<double>(result.in_no_cell);
    const double nowhere = share * static_cast<double>(result.nowhere);
    all.push_back({{"scale", jsonOf(level)},
                   {"gaussians", gaussians},
                   {"mean", result.mean},
                   {"median", result.median},
                   {"floor", result.floor},
                   {"volume", result.volume},
                   {"in_no_cell", in_no_cell},
                   {"nowhere", nowhere},
                   {"points", result.count}});
    if (!command.json)
      std::printf("%-6s %10zu %10.4f %10.4f %10.4f %9.3f%% %9.3f%% %10zu\n", textOf(level).c_str(), gaussians,
                  result.mean, result.median, result.floor, 100.0 * in_no_cell, 100.0 * nowhere, result.count);
  }
  if (command.json) printJson({{"map", command.subject}, {"background", scoring.background}, {"scales", all}});
}
template void scoreMap<2>(const HausdorffCommand&);
template void scoreMap<3>(const HausdorffCommand&);

}  // namespace gaussmap::app
