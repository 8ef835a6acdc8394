// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/timed_poses.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace gaussmap::detail {
namespace {

using std::chrono::nanoseconds;

bool areEqual(const Pose& a, const Pose& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

Pose between(const Pose& a, const Pose& b, double share) {
  const Eigen::Quaterniond qa(a.rotation), qb(b.rotation);
  return normalised({a.translation + share * (b.translation - a.translation), Pose::Rotation(qa.slerp(share, qb))});
}

}  // namespace

void TimedPoses::add(nanoseconds time, const Pose& pose) {
  const Pose unit = normalised(pose);
  if (!times_.empty()) {
    sorted_ = sorted_ && times_.back() < time;
    step_back_ = std::max(step_back_, times_.back() - time);
    constant_ = constant_ && areEqual(poses_.back(), unit);
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
      return between(poses_[after - 1], poses_[after],
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

std::optional<nanoseconds> medianInterval(std::vector<nanoseconds> times) {
  std::sort(times.begin(), times.end());
  std::vector<nanoseconds> steps;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] != times[i - 1]) steps.push_back(times[i] - times[i - 1]);
  if (steps.empty()) return std::nullopt;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace gaussmap::detail
