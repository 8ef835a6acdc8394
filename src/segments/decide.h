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

/// Decides for each of these segments, and for those that result, whether to split it, merge it or do nothing. The
/// highest utility wins, Leal 2000 eq. [3]. With SegmentFitterOptions::split_holes, a segment with a long hole is
/// always split there. A segment whose evidence has hardly grown since its last decision is skipped. With
/// ParticleLimit::Segment no segment is skipped, because particles are exchanged without growth.
DecisionCounts decide(const std::vector<int>& touched, const SegmentVotes& votes, const SegmentFitterOptions& options,
                      SegmentStore& store);

}  // namespace gaussmap::detail
