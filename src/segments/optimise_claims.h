// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "segments/working_set.h"

namespace gaussmap::detail {

/// A segment that explains an atom of evidence, and how many of its observations.
struct Claim {
  int segment = kNone;
  double explained = 0.0;
};

enum class ClaimSide {
  Any,  ///< all segments
  Same  ///< only those that look the same way as the segment that gathered the atom
};

/// Per atom the segments that explain it, the best first.
std::vector<std::vector<Claim>> claimsOf(WorkingSet& set, ClaimSide side);
/// Gives every atom to the segment that explains it best.
void reassign(WorkingSet& set);
/// Deletes segments that cost more than they explain beside the others, the worst first.
void removeRedundant(WorkingSet& set);

}  // namespace gaussmap::detail
