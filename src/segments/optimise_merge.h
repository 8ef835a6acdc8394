// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "segments/working_set.h"

namespace gaussmap::detail {

/// Merges neighbouring segments of similar direction until no merge increases the score.
void mergeNeighbours(WorkingSet& set);

}  // namespace gaussmap::detail
