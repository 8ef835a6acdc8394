// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/explained_score.h"
#include "segments/segment_index.h"

namespace gaussmap::detail {

/// A cell of evidence of an original segment.
struct EvidenceAtom {
  LineMoments hits;
  int owner = kNone;   ///< the original segment
  double share = 0.0;  ///< share of the owner's evidence
};

/// A copy of the segments, which the steps of optimiseSegments() change to a better set.
struct WorkingSet {
  /// Keeps a reference to `given`, which must outlive this object.
  WorkingSet(const std::deque<LiveSegment>& given, const SegmentFitterOptions& options);

  const std::deque<LiveSegment>& originals;
  double cell_size, gap;  ///< as in SegmentFitterOptions [m]
  ExplainedScore score;
  std::vector<EvidenceAtom> atoms;
  std::deque<LiveSegment> segments;
  SegmentIndex index;

  void remove(int id);
  /// Builds the index again from all segments, each extended by `reach` [m] at both ends.
  void enterAll(double reach);
  Strip strip(const LiveSegment& segment, double reach) const;
  /// Links ends to starts near them. Removes links between an end and a start that are too far apart.
  void linkNear();
  /// Returns true if a segment is the short side between two corners, as at the end of a thin wall. Rays hardly show
  /// whether it exists, but without it the corners would be lost.
  bool closesCorner(int id) const;
  /// Returns the segments that are alive, numbered without gaps and linked.
  std::deque<LiveSegment> result();
};

}  // namespace gaussmap::detail
