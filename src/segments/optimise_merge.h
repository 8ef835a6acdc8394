// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "segments/working_set.h"

namespace gaussmap::detail {

/// Merges neighbours along a line for as long as this increases the score.
void mergeNeighbours(WorkingSet& set);

}  // namespace gaussmap::detail
