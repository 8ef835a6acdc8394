// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/live_segment.h"
#include "segments/segment_index.h"

namespace gaussmap::detail {

/// The segments of a map while it grows, by number: their chains, and an index of the places that they cover. Numbers
/// of deleted segments are used again.
class SegmentStore {
 public:
  explicit SegmentStore(const SegmentFitterOptions& options)
      : growth_(options.growth), min_half_width_(options.min_half_width) {}

  const std::deque<LiveSegment>& segments() const { return segments_; }
  std::deque<LiveSegment>& segments() { return segments_; }
  const LiveSegment& operator[](int id) const { return segments_[static_cast<std::size_t>(id)]; }
  LiveSegment& operator[](int id) { return segments_[static_cast<std::size_t>(id)]; }

  /// A new segment, alive but without evidence; returns its number.
  int create();
  /// Deletes a segment.
  void remove(int id);
  /// The cells before number `cut` stay, the others become a new segment. Returns the number of the new one.
  int split(int id, std::size_t cut, bool linked);
  void merge(int into, int from);
  /// Deletes segments that many more rays cross than end on. Returns how many.
  std::size_t prune();

  /// The polygon whose points belong to a segment, Leal 2000 sec. 4.1.
  Strip polygon(const LiveSegment& segment) const;
  /// Enters a segment into the index, at the place where it is now.
  void enter(int id) { index_.update(id, polygon((*this)[id])); }
  /// Numbers of all segments whose polygon contains the point, and some others near it.
  const std::vector<int>& near(const Vector<2>& point) const { return index_.near(point); }

  std::size_t bytes() const;

 private:
  double growth_, min_half_width_;
  std::deque<LiveSegment> segments_;
  std::vector<int> unused_;  // numbers of segments that are not alive
  SegmentIndex index_;
};

}  // namespace gaussmap::detail
