// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "common/command.h"
#include "gaussmap/sensor/visibility.h"

namespace gaussmap::app {

/// The constants of the rules for moving objects, of MovingPoints or of OnlineMapper.
struct EvidenceConstants {
  OccupancyOptions& occupancy;
  VisibilityOptions& visibility;
  std::optional<double>& link;
  std::optional<double>& reach;
};

/// Adds --hit, --miss, --tolerance, --clearance, --link and --reach.
std::vector<Option> addEvidenceOptions(Command& command, const EvidenceConstants& constants);
/// Throws UsageError if `link` exceeds 1000 cells of the side `resolution` [m].
void checkLink(const std::optional<double>& link, double resolution);

}  // namespace gaussmap::app
