// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "segments/segment_store.h"
#include "segments/segment_votes.h"

namespace gaussmap::detail {

struct DecisionCounts {
  std::size_t splits = 0;
  std::size_t merges = 0;
};

/// Decides on each of these segments, and on those that result, whether it is split, merged or left alone: the highest
/// utility wins, Leal 2000 eq. [3]. Segments with a hole longer than `gap` [m] are split there in any case. A segment
/// whose evidence has hardly grown since the last decision is left alone.
DecisionCounts decide(const std::vector<int>& touched, const SegmentVotes& votes, double gap, SegmentStore& store);

}  // namespace gaussmap::detail
