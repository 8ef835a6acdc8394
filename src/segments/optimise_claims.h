// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "segments/working_set.h"

namespace gaussmap::detail {

/// A segment that explains an evidence atom, and how many of the atom's observations it explains.
struct Claim {
  int segment = kNone;
  double explained = 0.0;
};

enum class ClaimSide {
  Any,  ///< all segments
  Same  ///< only those with about the same direction as the owner of the atom
};

/// Returns per atom the segments that explain it, the best first.
std::vector<std::vector<Claim>> claimsOf(WorkingSet& set, ClaimSide side);
/// Assigns each atom to the segment that explains it best. Omits atoms that no segment explains.
void reassign(WorkingSet& set);
/// Deletes segments that cost more than the evidence which only they explain, the worst first.
void removeRedundant(WorkingSet& set);

}  // namespace gaussmap::detail
