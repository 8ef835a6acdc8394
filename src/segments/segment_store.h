// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/live_segment.h"
#include "segments/segment_index.h"

namespace gaussmap::detail {

/// The segments of the map that a SegmentFitter builds, by number, with their chains and a spatial index. Numbers of
/// deleted segments are used again.
class SegmentStore {
 public:
  explicit SegmentStore(const SegmentFitterOptions& options)
      : growth_(options.growth), min_half_width_(options.min_half_width) {}

  const std::deque<LiveSegment>& segments() const { return segments_; }
  std::deque<LiveSegment>& segments() { return segments_; }
  const LiveSegment& operator[](int id) const { return segments_[static_cast<std::size_t>(id)]; }
  LiveSegment& operator[](int id) { return segments_[static_cast<std::size_t>(id)]; }

  /// Creates a segment that is alive but has no evidence. Returns its number.
  int create();
  /// Deletes a segment.
  void remove(int id);
  /// Moves the cells from number `cut` on into a new segment. Links it to the old one if `linked`. Returns its number.
  int split(int id, std::size_t cut, bool linked);
  void merge(int into, int from);
  /// Deletes segments that many more rays cross than end on. Returns how many it deleted.
  std::size_t prune();

  /// Returns the polygon whose observations belong to a segment, Leal 2000 sec. 4.1.
  Strip polygon(const LiveSegment& segment) const;
  /// Enters the current position of a segment into the index.
  void enter(int id) { index_.update(id, polygon((*this)[id])); }
  /// Returns the numbers of all segments whose polygon contains the point, and of some others near it.
  const std::vector<int>& near(const Vector<2>& point) const { return index_.near(point); }

  std::size_t bytes() const;

 private:
  double growth_, min_half_width_;
  std::deque<LiveSegment> segments_;
  std::vector<int> unused_;  // numbers of segments that are not alive
  SegmentIndex index_;
};

}  // namespace gaussmap::detail
