// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"

namespace gaussmap::detail {

/// How far the times of poses may be from the time of a lookup.
struct PoseTimeLimits {
  std::chrono::nanoseconds interpolation{0};  ///< interpolate between two poses that are at most this far apart
  std::chrono::nanoseconds nearest{0};        ///< otherwise take the nearest pose, if it is at most this far away
};

/// What happened when poses were looked up at a time.
struct PoseLookup {
  std::string reason;       ///< why there is no pose
  bool is_outside = false;  ///< there is no pose, because the time is before the first or after the last one
  std::chrono::nanoseconds to_nearest{0};  ///< largest distance to a pose that was taken without interpolation
};

/// Poses at times. Call finish() once after the last add(); then all functions are thread-safe.
class TimedPoses {
 public:
  /// Adds a pose. It must have no fault (see poseFault()); the quaternion is normalised.
  void add(std::chrono::nanoseconds time, const Pose& pose);
  /// Sorts the poses by time. Of several poses at one time, the last one added remains.
  void finish();

  bool empty() const { return times_.empty(); }
  std::size_t size() const { return times_.size(); }
  std::chrono::nanoseconds first() const { return times_.front(); }
  std::chrono::nanoseconds last() const { return times_.back(); }
  /// Returns true if all poses are equal.
  bool isConstant() const { return constant_; }
  /// Returns the first pose. There must be one.
  const Pose& front() const { return poses_.front(); }

  /// Returns the largest step back between poses in the order in which they were added; 0 if all times ascend.
  std::chrono::nanoseconds stepBack() const { return step_back_; }

  /// Returns the pose at a time: linear interpolation of the translation, slerp of the rotation. Returns std::nullopt
  /// if the limits do not allow it. Sets all members of `lookup` but the reason. Takes O(log n).
  std::optional<Pose> at(std::chrono::nanoseconds time, const PoseTimeLimits& limits, PoseLookup& lookup) const;
  /// Returns the distance from a time to the nearest time of a pose. There must be one.
  std::chrono::nanoseconds distance(std::chrono::nanoseconds time) const;

 private:
  std::vector<std::chrono::nanoseconds> times_;
  std::vector<Pose> poses_;
  bool sorted_ = true;
  bool constant_ = true;
  std::chrono::nanoseconds step_back_{0};
};

}  // namespace gaussmap::detail
