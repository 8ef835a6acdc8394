// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include "gaussmap/segments/utility.h"
#include "segments/live_segment.h"

namespace gaussmap::detail {

/// Asks a utility for its votes. Segments have coordinates relative to origin(); the utility gets the map frame.
class SegmentVotes {
 public:
  explicit SegmentVotes(std::shared_ptr<SegmentUtility> utility) : utility_(std::move(utility)) {}

  void setOrigin(const Vector<2>& origin) { origin_ = origin; }
  const Vector<2>& origin() const { return origin_; }
  const SegmentUtility& utility() const { return *utility_; }

  double split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const {
    return utility_->split(inMap(whole), inMap(first), inMap(second));
  }
  double merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const {
    return utility_->merge(inMap(first), inMap(second), inMap(whole));
  }
  double nothing(const SegmentGoals& segment) const { return utility_->nothing(inMap(segment)); }
  /// Gives the utility the current position of the observer [m], map frame.
  void observe(const Vector<2>& position) { utility_->observe(position); }
  bool reconsider(const LiveSegment& segment) const {
    return utility_->reconsider(segment.start() + origin_, segment.finish() + origin_);
  }

 private:
  SegmentGoals inMap(SegmentGoals goals) const {
    goals.start += origin_;
    goals.end += origin_;
    return goals;
  }

  std::shared_ptr<SegmentUtility> utility_;
  Vector<2> origin_{0.0, 0.0};
};

}  // namespace gaussmap::detail
