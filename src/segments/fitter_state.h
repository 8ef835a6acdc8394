// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/evidence_collector.h"
#include "segments/free_space.h"
#include "segments/scan_beams.h"
#include "segments/scan_pieces.h"
#include "segments/segment_store.h"
#include "segments/segment_votes.h"

namespace gaussmap::detail {

/// The state of a SegmentFitter, and the steps of its add() in their order.
struct SegmentFitterState {
  SegmentFitterState(const SegmentFitterOptions& given, std::shared_ptr<SegmentUtility> utility,
                     std::shared_ptr<const ObservationModel> model)
      : options(given), votes(std::move(utility)), collector(given, std::move(model)), store(given) {}

  SegmentStatistics add(const LaserScan& scan);
  SegmentStatistics observe(const Vector<2>& position);
  /// Links two segments if neighbouring beams end on them and their ends are near each other.
  void linkNeighbours(const std::vector<BeamRun>& runs, const std::vector<int>& owners);
  /// Decides on the touched segments, and on those that the utility wants to reconsider.
  void vote(std::vector<int> touched, SegmentStatistics& statistics);
  void describe(SegmentStatistics& statistics) const;
  /// Returns the share of the beams that end near a segment.
  double coverage(const ScanBeams& beams) const;

  SegmentFitterOptions options;
  SegmentVotes votes;  ///< its origin is the first sensor position in whole metres; all sums are relative to it
  EvidenceCollector collector;
  SegmentStore store;
  Views views;
  std::int64_t scans = 0;
  std::uint64_t observations = 0;
};

}  // namespace gaussmap::detail
