// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The goal functions o_1, o_2, ... of a segment's evidence that utilities are made of, Leal 2000 sec. 4.2 eq. [3].
struct SegmentGoals {
  double normal_variance = 0.0;  ///< o_1 = sigma_n^2 of the evidence across the line [m^2]
  double length = 0.0;           ///< o_2 [m]
  double weight = 0.0;           ///< observations
  double cells = 0.0;            ///< cells along the line with evidence
  double misfit = 0.0;           ///< sum over these cells of their squared distance from the line [m^2]
  Vector<2> start{0.0, 0.0};     ///< end points [m], map frame
  Vector<2> end{0.0, 0.0};
};

/// Votes for what happens to a segment; the highest wins, Leal 2000 eq. [3]. Equal votes: nothing happens.
class GAUSSMAP_API SegmentUtility {
 public:
  virtual ~SegmentUtility() = default;
  /// U_split: for `whole` to become `first` and `second`, which are what its best break point leaves.
  virtual double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const = 0;
  /// U_merge: for `first` and `second` to become `whole`.
  virtual double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const = 0;
  /// U_nothing.
  virtual double nothing(const SegmentGoals&) const { return 0.0; }
  /// The observer is now here [m], map frame: told before every scan.
  virtual void observe(const Vector<2>&) {}
  /// Whether a segment with these ends, without new evidence, is to be decided on again because the observer has moved.
  virtual bool reconsider(const Vector<2>& start, const Vector<2>& end) const;
  /// Whether SegmentFitter::map() may optimise all segments together (SegmentFitterOptions::optimise). Only where the
  /// votes are by description length: it would undo what votes for other goals have decided.
  virtual bool optimisable() const { return false; }
};

/// Leal 2000 eq. [4]. Votes are 1 for yes and 0 for no, nothing always has 0.5.
struct ViewpointInvariantOptions {
  double sigma_threshold = 0.06;  ///< sigma_th, greatest standard deviation across a segment [m], > 0
  double min_length = 1.0;        ///< l_min, shorter segments are not split [m], > 0
  double merge_ratio = 0.5;       ///< alpha, merge where the variance is at most alpha sigma_th^2, in [0, 1)
};

class GAUSSMAP_API ViewpointInvariantUtility : public SegmentUtility {
 public:
  /// Throws std::invalid_argument, naming the option.
  explicit ViewpointInvariantUtility(const ViewpointInvariantOptions& options = {});
  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const override;
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const override;
  double nothing(const SegmentGoals&) const override { return 0.5; }

 private:
  ViewpointInvariantOptions options_;
};

/// Leal 2000 eq. [5]: as eq. [4], with a smaller l_min where a segment meets the field VF round the observer.
struct ViewpointDependentOptions {
  ViewpointInvariantOptions far;  ///< outside the field
  double radius = 5.0;            ///< of the field [m], > 0
  double scale = 0.33;            ///< l_min within the field is scale times that outside, in (0, 1]
  /// Where the observer stays [m], map frame. Without `fixed` it is the sensor of the last scan.
  Vector<2> viewpoint{0.0, 0.0};
  bool fixed = false;
};

/// The paper's text says that the map reverts where the observer has left, its equation does not: here two segments
/// outside the field that together are shorter than l_min, which only a visit can have split, are merged again.
class GAUSSMAP_API ViewpointDependentUtility : public SegmentUtility {
 public:
  /// Throws std::invalid_argument, naming the option.
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

/// Votes are what the description gets shorter by [nat]: a segment costs `segment_cost`, a cell along it as much as its
/// distance from the line is unlikely. A cell counts once however often it was seen: poses are wrong by the same
/// few centimetres each time, and a wall is not split for having been looked at for long.
struct DescriptionLengthOptions {
  double sigma = 0.03;        ///< of a cell's distance from the line: sensor, pose and wall together [m], > 0
  double segment_cost = 3.0;  ///< kappa [nat], >= 0
};

class GAUSSMAP_API DescriptionLengthUtility : public SegmentUtility {
 public:
  /// Throws std::invalid_argument, naming the option.
  explicit DescriptionLengthUtility(const DescriptionLengthOptions& options = {});
  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const override;
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const override;
  bool optimisable() const override { return true; }

 private:
  DescriptionLengthOptions options_;
};

/// A utility made of functions; those that are empty never win.
struct GAUSSMAP_API UserUtility : public SegmentUtility {
  using Split = std::function<double(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second)>;
  using Merge = std::function<double(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole)>;
  using Nothing = std::function<double(const SegmentGoals& segment)>;
  Split split_vote;
  Merge merge_vote;
  Nothing nothing_vote;

  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const override;
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const override;
  double nothing(const SegmentGoals& segment) const override;
};

/// The weighted sum of other utilities' votes.
class GAUSSMAP_API CombinedUtility : public SegmentUtility {
 public:
  struct Part {
    std::shared_ptr<SegmentUtility> utility;
    double weight = 1.0;
  };
  /// Throws std::invalid_argument without parts, for an empty pointer or a weight that is not finite.
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
