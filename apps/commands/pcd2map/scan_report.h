// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "commands/planar_input.h"
#include "common/json.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap::app {

/// Throws std::runtime_error if no point is usable. The message says why the points were dropped.
void requirePoints(const PointCounts& counts, const Scans& scans, const Slice& slice);

Json countsJson(const PointCounts& counts);

/// Returns the step of the history for a map from scans.
Json historyOf(const Scans& scans, const PointCounts& counts, const Slice& slice);

/// "20 scans, 2203027 points (left out: ...)".
std::string summaryOf(const Scans& scans, const PointCounts& counts, const Slice& slice);

}  // namespace gaussmap::app
