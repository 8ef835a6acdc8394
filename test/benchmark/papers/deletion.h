// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "evaluation/removal_score.h"
#include "papers/report.h"

namespace gaussmap::papers {

/// What an on-line map has learnt of a world with moving objects.
struct DeletionRow {
  std::string method;
  detail::RemovalScore score;  ///< a point counts as removed if the map does not have its finest cell at the end
  double finest_mean = 0.0;    ///< mean distance of samples of the finest scale from the surface at rest [m]
};

/// Maps the simulated street with traffic as printed, and with the defaults of the library. At most `scans` scans;
/// 0: all 60.
std::vector<DeletionRow> runDeletion(std::size_t scans);

/// Adds the table and the claims to the report.
void reportDeletion(const std::vector<DeletionRow>& rows, Report& report);

}  // namespace gaussmap::papers
