// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/explained_score.h"
#include "segments/segment_index.h"

namespace gaussmap::detail {

/// A cell of evidence, as the original segments gathered it.
struct EvidenceAtom {
  LineMoments hits;
  int owner = kNone;   ///< the original segment
  double share = 0.0;  ///< of the evidence of that segment
};

/// A copy of segments on the way to a better set, which the steps of optimiseSegments() change.
struct WorkingSet {
  /// Refers to `given`, which must outlive it.
  WorkingSet(const std::deque<LiveSegment>& given, const SegmentFitterOptions& options);

  const std::deque<LiveSegment>& originals;
  double cell_size, gap;  ///< as in SegmentFitterOptions [m]
  ExplainedScore score;
  std::vector<EvidenceAtom> atoms;
  std::deque<LiveSegment> segments;
  SegmentIndex index;

  void remove(int id);
  /// Enters all segments into the index, longer by `reach` [m] at both ends.
  void enterAll(double reach);
  Strip strip(const LiveSegment& segment, double reach) const;
  /// Links ends to starts that lie near by; links between ends that do not are undone.
  void linkNear();
  /// Whether a segment is the short side between two corners, as at the end of a thin wall: rays hardly tell whether it
  /// is there, but without it there are no corners.
  bool closesCorner(int id) const;
  /// The segments that are alive, numbered without gaps, linked.
  std::deque<LiveSegment> result();
};

}  // namespace gaussmap::detail
