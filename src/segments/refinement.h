// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <vector>

#include "segments/fitter_state.h"
#include "segments/worth.h"

namespace gaussmap::detail {

/// A copy of the segments of a state on the way to a better set. Its steps in the order of refineSegments().
class Refinement {
 public:
  explicit Refinement(const SegmentFitterState& state);

  // refinement.cpp
  /// Every segment becomes those stretches of it that are worth keeping, looking at all rays that passed.
  void cut();
  /// Links ends to starts that lie near by; links between ends that do not are undone.
  void linkNear();
  /// What is left, without gaps in the numbers.
  std::deque<LiveSegment> result();

  // refine_merge.cpp
  /// Merges neighbours along a line while it is worth more.
  void merge();

  // refine_claims.cpp
  /// Gives every cell of evidence to the segment that explains it best.
  void reassign();
  /// Deletes, worst first, what is not worth its cost beside the others.
  void removeRedundant();

  // refine_fill.cpp
  /// Deletes short segments that explain little, and lays new ones through all that nothing explains.
  void fill();

 private:
  /// A cell of evidence, as the state's segments gathered it.
  struct Atom {
    LineMoments hits;
    int owner = kNone;   // that segment of the state
    double share = 0.0;  // of what the segment has
  };
  struct Claim {
    int segment = kNone;
    double explained = 0.0;
  };
  enum class Side { Any, Same };
  class Search;

  /// Per atom the segments that explain it, best first: of all, or of those that look the same way.
  std::vector<std::vector<Claim>> claims(Side side);
  /// Enters all segments into the index, longer by `reach` at both ends.
  void enterAll(double reach);
  Strip strip(const LiveSegment& segment, double reach) const;
  bool mergeBest(int id);
  /// Whether a segment is the short side between two corners, as at the end of a thin wall: a ray hardly tells whether
  /// it is there, but without it there are no corners.
  bool closesCorner(int id) const;
  void remove(int id);
  /// A segment of these atoms along a line.
  LiveSegment fromAtoms(const std::vector<int>& members, const LineFit& line) const;

  const SegmentFitterState& state_;
  Worth worth_;
  std::vector<Atom> atoms_;
  std::deque<LiveSegment> segments_;
  SegmentIndex index_;
};

}  // namespace gaussmap::detail
