// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/free_space.h"
#include "segments/live_segment.h"
#include "segments/scan_beams.h"
#include "segments/segment_index.h"

namespace gaussmap::detail {

struct SegmentFitterState {
  SegmentFitterOptions options;
  std::shared_ptr<SegmentUtility> utility;
  std::unique_ptr<ObservationModel> model;
  std::unique_ptr<EvidenceKeeper> keeper;

  Vector<2> origin{0.0, 0.0};  ///< first sensor position, whole metres: sums are taken about it
  std::int64_t scans = 0;
  std::uint64_t observations = 0, settled = 0;  ///< numbers for the random generators
  std::deque<LiveSegment> segments;
  std::vector<int> unused;  ///< numbers of segments that are not alive
  SegmentIndex index;
  Views views;
  std::vector<ObservationPoint> points;  ///< of the observation at hand

  // add_scan.cpp
  SegmentStatistics add(const LaserScan& scan);
  /// The segment that the end of a beam falls to; kNone if there is none. `piece`: of straightPieces().
  int associate(const Vector<2>& hit, const Vector<2>& sensor, const Vector<2>& piece) const;
  void take(const ScanBeams& beams, std::size_t beam, LiveSegment& segment);
  void describe(const ScanBeams& beams, SegmentStatistics& statistics) const;

  // new_segments.cpp
  /// New segments from the beams [first, last), which fall to none: split as the utility wants it.
  void createFrom(const ScanBeams& beams, std::size_t first, std::size_t last, std::vector<int>& owners,
                  std::vector<int>& touched);
  /// A segment of these beams' ends, to think about.
  LiveSegment segmentOf(const ScanBeams& beams, std::size_t first, std::size_t last) const;

  // decide.cpp
  /// For every touched segment the highest utility wins, Leal 2000 eq. [3].
  void decide(const std::vector<int>& touched, SegmentStatistics& statistics);
  /// Segments that a merge is thought about with: its neighbours in the chain, and what lies alongside.
  std::vector<int> mergePartners(int id) const;

  // fitter_state.cpp
  int create();
  void remove(int id);
  /// The cells before number `cut` stay, the others become a new segment, whose number it returns.
  int split(int id, std::size_t cut, bool linked);
  void merge(int into, int from);
  /// Deletes segments that many more rays cross than end on, and says how many.
  std::size_t prune();
  /// The polygon whose points fall to a segment.
  Strip polygon(const LiveSegment& segment) const;
  void enter(int id) { index.update(id, polygon(segments[id])); }
  SegmentGoals inMap(SegmentGoals goals) const;
};

}  // namespace gaussmap::detail
