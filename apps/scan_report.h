// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "common.h"
#include "gaussmap/mapping/accumulate_scans.h"

namespace gaussmap::app {

/// Throws unless some point was usable, and says what became of them.
void requirePoints(const PointCounts& counts, const Scans& scans);

Json countsJson(const PointCounts& counts);

/// The step of the history that scans make.
Json historyOf(const Scans& scans, const PointCounts& counts);

/// "20 scans, 2203027 points (left out: ...)".
std::string summaryOf(const Scans& scans, const PointCounts& counts);

}  // namespace gaussmap::app
