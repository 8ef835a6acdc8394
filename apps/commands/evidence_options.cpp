// SPDX-License-Identifier: BSD-3-Clause
#include "commands/evidence_options.h"

#include "common/usage.h"

namespace gaussmap::app {

std::vector<Option> addEvidenceOptions(Command& command, const EvidenceConstants& constants) {
  constexpr double kLeast = 1e-3, kMost = 10.0, kFarthest = 1e6;
  return {
      command.number("--hit", constants.occupancy.hit, kLeast, kMost,
                     "log-odds that a cell gains per scan with a point in the cell"),
      command.number("--miss", constants.occupancy.miss, kLeast, kMost,
                     "log-odds that a cell loses per scan that sees through the cell"),
      command.number("--tolerance", constants.visibility.tolerance, 0.0, kFarthest,
                     "a ray sees through a cell only if it ends more than this behind the cell [m]; default: 0.3, less "
                     "for cells below 0.015"),
      command.number("--clearance", constants.visibility.clearance, 0.0, kFarthest,
                     "a ray sees through a cell only if the cell is this far from the surface where the ray ends [m]; "
                     "default: 0.35, less for cells below 0.015"),
      command.number(
          "--link", constants.link, 0.0, kFarthest,
          "maximum distance from one cell of an object to the next [m]; default: 0.2, less for cells below 0.015"),
      command.number(
          "--reach", constants.reach, 0.0, kFarthest,
          "how far an object can reach beyond its freed cells [m]; default: 0.5, less for cells below 0.015"),
  };
}

void checkLink(const std::optional<double>& link, double resolution) {
  constexpr double kMaxCells = 1000.0;
  if (link && *link > kMaxCells * resolution)
    throw UsageError("--link: must be at most 1000 cells; use a smaller value or a larger --resolution");
}

}  // namespace gaussmap::app
