// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Properties of a segment and its evidence. Utilities are computed from them. The paper calls them goal functions o_1,
/// o_2, ..., Leal 2000 sec. 4.2 eq. (3).
struct SegmentGoals {
  double normal_variance = 0.0;  ///< o_1 = sigma_n^2, variance of the evidence at right angles to the line [m^2]
  double length = 0.0;           ///< o_2, length of the segment [m]
  double weight = 0.0;           ///< number of observations
  /// Number of cells along the line that have evidence. A cell with n observations counts n / (n + 1).
  double cells = 0.0;
  /// Sum over these cells [m^2]. A cell adds n / (n + 1) times the mean squared distance between its observations and a
  /// line. The line is the one that fits all these cells best.
  double misfit = 0.0;
  Vector<2> start{0.0, 0.0};  ///< first end point [m], map frame
  Vector<2> end{0.0, 0.0};    ///< second end point [m], map frame
};

/// Votes for a split, a merge or no change of a segment. The highest vote wins, Leal 2000 eq. (3). A split or merge
/// wins only if its vote is higher than the vote for no change.
class GAUSSMAP_API SegmentUtility {
 public:
  virtual ~SegmentUtility() = default;
  /// Returns U_split, the vote for splitting `whole` into `first` and `second` at its best break point.
  virtual double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const = 0;
  /// Returns U_merge, the vote for merging `first` and `second` into `whole`.
  virtual double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const = 0;
  /// Returns U_nothing, the vote for no change.
  virtual double nothing(const SegmentGoals&) const { return 0.0; }
  /// Receives the position of the observer [m, map frame]: of the sensor before every scan, and those given to
  /// SegmentFitter::observe().
  virtual void observe(const Vector<2>&) {}
  /// Returns true if a segment with these end points needs new votes, although it has no new evidence. The reason can
  /// be that the observer has moved.
  virtual bool reconsider(const Vector<2>& start, const Vector<2>& end) const;
  /// Returns true if SegmentFitter::map() may optimise all segments together (see SegmentFitterOptions::optimise). A
  /// utility of your own should return true only if its votes are description lengths. The optimisation would undo
  /// decisions that have other goals.
  virtual bool optimisable() const { return false; }
};

/// Options of ViewpointInvariantUtility, Leal 2000 eq. (4).
struct ViewpointInvariantOptions {
  double sigma_threshold = 0.06;  ///< sigma_th, segments with at least this sigma_n are split [m], > 0
  double min_length = 1.0;        ///< l_min, shorter segments are not split [m], > 0
  double merge_ratio = 0.5;       ///< alpha, a merge needs sigma_n^2 <= alpha sigma_th^2, in [0, 1)
};

/// The viewpoint-invariant utility of the paper, Leal 2000 eq. (4). The vote for a split or a merge is 1 (yes) or 0
/// (no). The vote for no change is always 0.5.
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
  ViewpointInvariantOptions far;  ///< options for segments outside the field VF
  double radius = 5.0;            ///< radius of the field VF, a circle around the observer [m], > 0
  double scale = 0.33;            ///< l_min inside the field is `scale` times l_min outside, in (0, 1]
  /// Position of the observer [m], map frame. If `fixed` is false, each scan replaces it by the position of the sensor,
  /// and SegmentFitter::observe() by the given position.
  Vector<2> viewpoint{0.0, 0.0};
  bool fixed = false;  ///< true: the observer stays at `viewpoint`
};

/// The viewpoint-dependent utility of the paper, Leal 2000 eq. (5). It is like eq. (4), with a smaller l_min for
/// segments that meet the field around the observer.
///
/// After the observer has left, the splits near its place are undone. The text of the paper says this, but its equation
/// does not. This class merges two segments outside the field if together they are shorter than l_min. Most of them
/// come from splits when the observer was near. Segments that were short from the beginning are merged too. Outside the
/// field, the map can therefore be coarser than that of eq. (4).
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
  double sigma = 0.03;        ///< standard deviation of observations from the line [m], > 0
  double segment_cost = 3.0;  ///< kappa, cost of a segment [nat], >= 0
};

/// A vote is the decrease of the description length by a split or merge [nat].
///
/// The description length is the sum of two costs. Each segment costs `segment_cost`. Each cell along a segment costs
/// the negative log-likelihood of its squared distance from the line: SegmentGoals::misfit divided by 2 sigma^2. A cell
/// counts n / (n + 1), so it counts at most once, however often it is seen. Otherwise, a wall that is observed for a
/// long time would be split because of pose errors of a few centimetres.
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

/// A utility whose votes come from functions. If a function is empty, its vote is minus infinity.
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
    std::shared_ptr<SegmentUtility> utility;  ///< must not be empty
    double weight = 1.0;                      ///< factor of the votes, finite
  };
  /// Makes a utility from its parts. Throws std::invalid_argument if there are no parts, a pointer is empty, or a
  /// weight is not finite.
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
