// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/timed_poses.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/interpolate_pose.h"
#include "core/same_pose.h"

namespace gaussmap::detail {
using std::chrono::nanoseconds;

void TimedPoses::add(nanoseconds time, const Pose& pose) {
  const Pose unit = normalised(pose);
  if (!times_.empty()) {
    sorted_ = sorted_ && times_.back() < time;
    step_back_ = std::max(step_back_, times_.back() - time);
    constant_ = constant_ && samePose(poses_.back(), unit);
  }
  times_.push_back(time);
  poses_.push_back(unit);
}

void TimedPoses::finish() {
  if (sorted_) return;
  std::vector<std::size_t> order(times_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) { return times_[a] < times_[b]; });
  std::vector<nanoseconds> times;
  std::vector<Pose> poses;
  for (const std::size_t i : order) {
    if (!times.empty() && times.back() == times_[i]) {
      poses.back() = poses_[i];
      continue;
    }
    times.push_back(times_[i]);
    poses.push_back(poses_[i]);
  }
  times_ = std::move(times);
  poses_ = std::move(poses);
  sorted_ = true;
}

std::optional<Pose> TimedPoses::at(nanoseconds time, const PoseTimeLimits& limits, PoseLookup& lookup) const {
  if (times_.empty()) return std::nullopt;
  const auto bound = std::lower_bound(times_.begin(), times_.end(), time);
  const auto after = static_cast<std::size_t>(bound - times_.begin());
  if (after < times_.size() && times_[after] == time) return poses_[after];
  if (after > 0 && after < times_.size()) {
    const nanoseconds step = times_[after] - times_[after - 1], part = time - times_[after - 1];
    if (step <= limits.interpolation)
      return interpolate(poses_[after - 1], poses_[after],
                         static_cast<double>(part.count()) / static_cast<double>(step.count()));
    if (std::min(part, step - part) > limits.nearest) return std::nullopt;
    lookup.to_nearest = std::max(lookup.to_nearest, std::min(part, step - part));
    return poses_[part <= step - part ? after - 1 : after];
  }
  if (distance(time) > limits.nearest) {
    lookup.is_outside = true;
    return std::nullopt;
  }
  lookup.to_nearest = std::max(lookup.to_nearest, distance(time));
  return after == 0 ? poses_.front() : poses_.back();
}

nanoseconds TimedPoses::distance(nanoseconds time) const {
  const auto after = std::lower_bound(times_.begin(), times_.end(), time);
  if (after == times_.end()) return time - times_.back();
  if (after == times_.begin()) return *after - time;
  return std::min(*after - time, time - *(after - 1));
}

}  // namespace gaussmap::detail
