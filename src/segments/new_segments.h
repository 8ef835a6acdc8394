// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "segments/evidence_collector.h"
#include "segments/scan_beams.h"
#include "segments/segment_store.h"
#include "segments/segment_votes.h"

namespace gaussmap::detail {

/// Creates segments from beams that belong to no segment of the map.
class NewSegments {
 public:
  /// `cell`: length of the cells along a segment [m].
  NewSegments(const SegmentVotes& votes, double cell, EvidenceCollector& collector, SegmentStore& store)
      : votes_(votes), cell_(cell), collector_(collector), store_(store) {}

  /// Creates one segment from the neighbouring beams [first, last), or several if the utility votes for splits. Writes
  /// the numbers of the segments to the `owners` of the beams, and appends them to `created`.
  void createFrom(const ScanBeams& beams, std::size_t first, std::size_t last, std::vector<int>& owners,
                  std::vector<int>& created);

 private:
  const SegmentVotes& votes_;
  double cell_;
  EvidenceCollector& collector_;
  SegmentStore& store_;
};

}  // namespace gaussmap::detail
