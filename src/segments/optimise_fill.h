// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "segments/working_set.h"

namespace gaussmap::detail {

/// Deletes short segments that explain little. Then fits new segments to the evidence that no segment explains.
void fillGaps(WorkingSet& set);

}  // namespace gaussmap::detail
