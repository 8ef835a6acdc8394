// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "papers/off_line.h"
#include "papers/over_time.h"
#include "papers/report.h"

namespace gaussmap::papers {

/// Adds the claims of Yguel 2009 that the refinement off line and on line can judge.
void claimRefinement(const std::vector<OffLine>& off_line, const std::vector<OverTime>& over_time, Report& report);

}  // namespace gaussmap::papers
