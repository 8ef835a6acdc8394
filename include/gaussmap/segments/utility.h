// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The goal functions o_1, o_2, ... of a segment's evidence, Leal 2000 sec. 4.2 eq. (3). Utilities are computed from
/// them.
struct SegmentGoals {
  double normal_variance = 0.0;  ///< o_1 = sigma_n^2 of the evidence across the line [m^2]
  double length = 0.0;           ///< o_2 [m]
  double weight = 0.0;           ///< number of observations
  double cells = 0.0;            ///< number of cells along the line with evidence
  double misfit = 0.0;           ///< sum over these cells of their squared distance from the line [m^2]
  Vector<2> start{0.0, 0.0};     ///< first end point [m], map frame
  Vector<2> end{0.0, 0.0};       ///< second end point [m], map frame
};

/// Votes for a split, a merge or no change of a segment. The highest vote wins, Leal 2000 eq. (3). If the votes are
/// equal, the segment does not change.
class GAUSSMAP_API SegmentUtility {
 public:
  virtual ~SegmentUtility() = default;
  /// Returns U_split, the vote for splitting `whole` into `first` and `second` at its best break point.
  virtual double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const = 0;
  /// Returns U_merge, the vote for merging `first` and `second` into `whole`.
  virtual double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const = 0;
  /// Returns U_nothing, the vote for no change.
  virtual double nothing(const SegmentGoals&) const { return 0.0; }
  /// Receives the position of the observer [m, map frame] before every scan.
  virtual void observe(const Vector<2>&) {}
  /// Returns true if a segment with these end points needs a new decision because the observer has moved. The function
  /// is called for segments without new evidence.
  virtual bool reconsider(const Vector<2>& start, const Vector<2>& end) const;
  /// Returns true if SegmentFitter::map() may optimise all segments together (see SegmentFitterOptions::optimise).
  /// Return true only if the votes are description lengths: the optimisation would undo decisions for other goals.
  virtual bool optimisable() const { return false; }
};

/// Options of ViewpointInvariantUtility, Leal 2000 eq. (4).
struct ViewpointInvariantOptions {
  double sigma_threshold = 0.06;  ///< sigma_th, maximum standard deviation across a segment [m], > 0
  double min_length = 1.0;        ///< l_min, shorter segments are not split [m], > 0
  double merge_ratio = 0.5;       ///< alpha, merges if the variance is at most alpha sigma_th^2, in [0, 1)
};

/// The viewpoint-invariant utility of the paper, Leal 2000 eq. (4). A vote is 1 for yes and 0 for no. The vote for no
/// change is always 0.5.
class GAUSSMAP_API ViewpointInvariantUtility : public SegmentUtility {
 public:
  /// Stores the options. Throws std::invalid_argument if an option is out of range; the message names the option.
  explicit ViewpointInvariantUtility(const ViewpointInvariantOptions& options = {});
  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const override;
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const override;
  double nothing(const SegmentGoals&) const override { return 0.5; }

 private:
  ViewpointInvariantOptions options_;
};

/// Options of ViewpointDependentUtility, Leal 2000 eq. (5).
struct ViewpointDependentOptions {
  ViewpointInvariantOptions far;  ///< outside the field
  double radius = 5.0;            ///< radius of the field VF around the observer [m], > 0
  double scale = 0.33;            ///< l_min inside the field is `scale` times l_min outside, in (0, 1]
  /// Position of the observer [m], map frame, if `fixed`. Otherwise it is the position of the sensor in the last scan.
  Vector<2> viewpoint{0.0, 0.0};
  bool fixed = false;  ///< true: the observer stays at `viewpoint`
};

/// The viewpoint-dependent utility of the paper, Leal 2000 eq. (5). It is like eq. (4), with a smaller l_min for
/// segments that meet the field around the observer.
///
/// According to the text of the paper, but not to its equation, the map reverts after the observer has left. This class
/// implements the text: it merges two segments outside the field that together are shorter than l_min. Only a visit can
/// have split them.
class GAUSSMAP_API ViewpointDependentUtility : public SegmentUtility {
 public:
  /// Stores the options. Throws std::invalid_argument if an option is out of range; the message names the option.
  explicit ViewpointDependentUtility(const ViewpointDependentOptions& options = {});
  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const override;
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const override;
  double nothing(const SegmentGoals&) const override { return 0.5; }
  void observe(const Vector<2>& position) override;
  bool reconsider(const Vector<2>& start, const Vector<2>& end) const override;

 private:
  bool inField(const Vector<2>& start, const Vector<2>& end, const Vector<2>& viewpoint) const;
  bool inField(const SegmentGoals& segment) const { return inField(segment.start, segment.end, viewpoint_); }

  ViewpointDependentOptions options_;
  ViewpointInvariantUtility near_, far_;
  Vector<2> viewpoint_, before_;
};

/// Options of DescriptionLengthUtility.
struct DescriptionLengthOptions {
  double sigma = 0.03;        ///< standard deviation of a cell from the line: sensor, pose and wall together [m], > 0
  double segment_cost = 3.0;  ///< kappa, cost of a segment [nat], >= 0
};

/// Votes with the decrease of the description length [nat].
///
/// A segment costs `segment_cost`. A cell along the segment costs the negative log-likelihood of its distance from the
/// line. A cell counts once, also if it is seen often. Pose errors of a few centimetres repeat, and a wall must not be
/// split only because it was observed for a long time.
class GAUSSMAP_API DescriptionLengthUtility : public SegmentUtility {
 public:
  /// Stores the options. Throws std::invalid_argument if an option is out of range; the message names the option.
  explicit DescriptionLengthUtility(const DescriptionLengthOptions& options = {});
  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const override;
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const override;
  bool optimisable() const override { return true; }

 private:
  DescriptionLengthOptions options_;
};

/// A utility that consists of functions. The vote of an empty function never wins.
struct GAUSSMAP_API UserUtility : public SegmentUtility {
  /// A function that returns U_split.
  using Split = std::function<double(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second)>;
  /// A function that returns U_merge.
  using Merge = std::function<double(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole)>;
  /// A function that returns U_nothing.
  using Nothing = std::function<double(const SegmentGoals& segment)>;
  Split split_vote;      ///< vote for a split
  Merge merge_vote;      ///< vote for a merge
  Nothing nothing_vote;  ///< vote for no change

  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const override;
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const override;
  double nothing(const SegmentGoals& segment) const override;
};

/// A utility whose votes are the weighted sums of the votes of other utilities.
class GAUSSMAP_API CombinedUtility : public SegmentUtility {
 public:
  /// A utility and its weight.
  struct Part {
    std::shared_ptr<SegmentUtility> utility;  ///< not empty
    double weight = 1.0;                      ///< finite
  };
  /// Makes a utility of parts. Throws std::invalid_argument if there are no parts, a pointer is empty, or a weight is
  /// not finite.
  explicit CombinedUtility(std::vector<Part> parts);
  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const override;
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const override;
  double nothing(const SegmentGoals& segment) const override;
  void observe(const Vector<2>& position) override;
  bool reconsider(const Vector<2>& start, const Vector<2>& end) const override;

 private:
  std::vector<Part> parts_;
};

}  // namespace gaussmap
