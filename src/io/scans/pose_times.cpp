// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/pose_times.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>

#include "core/interpolate_pose.h"
#include "core/quantile.h"

namespace gaussmap::detail {
namespace {

constexpr Instant kSmallestLimit = std::chrono::milliseconds(50);  // clocks and triggers differ by so much
constexpr Instant kLargestLimit = std::chrono::seconds(10);
// Motions between the nearest and the interpolated pose above these are reported.
constexpr double kNoticedMotion = 0.05;                          // [m]
constexpr double kNoticedTurn = 0.5 * 3.14159265358979 / 180.0;  // [rad]

Instant between(Instant a, Instant b) {
  return a < b ? b - a : a - b;
}

std::string shortTime(Instant time) {
  const double seconds = secondsOf(time);
  std::ostringstream text;
  text.precision(3);
  if (seconds < 1e-3)
    text << seconds * 1e6 << " us";
  else if (seconds < 1.0)
    text << seconds * 1e3 << " ms";
  else
    text << seconds << " s";
  return text.str();
}

/// The largest distance between the nearest and the interpolated poses.
struct LargestMotion {
  double metres = 0.0, turn = 0.0;
  std::size_t scan = 0;

  void add(const Pose& a, const Pose& b, std::size_t index) {
    const double d = (a.translation - b.translation).norm();
    const double r = Eigen::Quaterniond(a.rotation).angularDistance(Eigen::Quaterniond(b.rotation));
    if (d / kNoticedMotion + r / kNoticedTurn > metres / kNoticedMotion + turn / kNoticedTurn)
      metres = d, turn = r, scan = index;
  }
  bool noticed() const { return metres > kNoticedMotion || turn > kNoticedTurn; }
};

}  // namespace

/// The two poses around a time.
struct PoseTimes::Step {
  std::size_t before = 0, after = 0;
  double share = 0.0;  // of the way from the first to the second
};

std::vector<Instant> timesIn(const std::vector<Decimal>& written, TimeUnit unit) {
  std::vector<Instant> times;
  for (const Decimal& number : written) {
    const std::optional<Instant> time = toTime(number, unit);
    if (!time) return {};
    times.push_back(*time);
  }
  return times;
}

PoseTimes::PoseTimes(const PoseFile& file) : file_(file), order_(file.entries.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t(0));
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return *file_.entries[a].time < *file_.entries[b].time; });
}

TimeUnit PoseTimes::unitOf(const std::vector<Decimal>& scans) const {
  const TimeUnit usual = unitByMagnitude(largestOf(scans));
  const Instant first = time(0), last = time(order_.size() - 1),
                margin = (last - first) / 100 + std::chrono::milliseconds(1);
  const auto within = [&](TimeUnit unit) {
    const std::vector<Instant> times = timesIn(scans, unit);
    return static_cast<std::size_t>(std::count_if(
        times.begin(), times.end(), [&](Instant one) { return one >= first - margin && one <= last + margin; }));
  };
  if (within(usual) > 0 ||
      std::any_of(scans.begin(), scans.end(), [](const Decimal& one) { return one.exponent != 0; }))
    return usual;
  std::optional<TimeUnit> found;
  for (const TimeUnit unit : kTimeUnits) {
    if (2 * within(unit) < scans.size()) continue;
    if (found) return usual;
    found = unit;
  }
  return found.value_or(usual);
}

std::size_t PoseTimes::nearest(Instant wanted) const {
  const auto after = std::lower_bound(order_.begin(), order_.end(), wanted,
                                      [this](std::size_t i, Instant value) { return *file_.entries[i].time < value; });
  const auto i = static_cast<std::size_t>(after - order_.begin());
  if (i == 0) return 0;
  if (i == order_.size() || wanted - time(i - 1) < time(i) - wanted) {
    std::size_t first = i - 1;  // of several at this time
    while (first > 0 && time(first - 1) == time(i - 1)) --first;
    return first;
  }
  return i;
}

PoseTimes::Limits PoseTimes::limits(const std::vector<Instant>& times, const PoseMatching& options) const {
  if (options.max_time_gap) {
    const Instant given(static_cast<std::int64_t>(std::llround(std::min(*options.max_time_gap, 1e9) * 1e9)));
    return {given, given, given, given};
  }
  std::vector<Instant> own;
  for (std::size_t i = 0; i < order_.size(); ++i) own.push_back(time(i));
  const std::optional<Instant> of_scans = medianStep(times), of_poses = medianStep(std::move(own));
  const Instant pose_step = of_poses.value_or(Instant(0));
  Limits limits;
  limits.nearest = of_scans ? *of_scans / 2 : of_poses ? pose_step / 2 : kSmallestLimit;
  limits.nearest = std::min(limits.nearest, kLargestLimit);
  limits.outside = std::max(pose_step, kSmallestLimit);
  // One missing pose between two others is no gap, with some allowance for the jitter of the times.
  limits.usual = std::max(std::min(limits.nearest, std::max(2 * pose_step, kSmallestLimit)), 3 * pose_step / 4);
  limits.interpolated = std::min(std::max(limits.nearest, pose_step + pose_step / 5), kLargestLimit);
  return limits;
}

std::optional<PoseTimes::Step> PoseTimes::stepAt(Instant wanted) const {
  const auto bound = std::lower_bound(order_.begin(), order_.end(), wanted,
                                      [this](std::size_t i, Instant value) { return *file_.entries[i].time < value; });
  std::size_t after = static_cast<std::size_t>(bound - order_.begin());
  while (after < order_.size() && !entry(after).pose) ++after;
  if (after == order_.size()) return std::nullopt;
  if (time(after) == wanted) return Step{after, after, 0.0};
  std::size_t before = static_cast<std::size_t>(bound - order_.begin());
  while (before > 0 && !entry(before - 1).pose) --before;
  if (before == 0) return std::nullopt;
  --before;
  const auto whole = static_cast<double>((time(after) - time(before)).count());
  return Step{before, after, static_cast<double>((wanted - time(before)).count()) / whole};
}

void PoseTimes::requireOne(std::size_t i) const {
  for (std::size_t other = i + 1; other < order_.size() && time(other) == time(i); ++other) {
    const std::optional<Pose>&a = entry(i).pose, &b = entry(other).pose;
    if (a && b && (a->translation != b->translation || a->rotation.coeffs() != b->rotation.coeffs()))
      throw FileError(file_.path, "lines " + std::to_string(entry(i).line) + " and " +
                                      std::to_string(entry(other).line) + " have the same time but other poses");
  }
}

void PoseTimes::warnOfSharedPoses(const std::vector<Instant>& times, const std::vector<ScanKey>& scans,
                                  const std::vector<std::optional<std::size_t>>& nearest, MatchedPoses& matched) const {
  std::map<std::pair<std::int64_t, bool>, std::size_t> users;
  std::size_t pairs = 0;
  std::string first;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!matched.poses[i]) continue;
    // The same time, or the same pose.
    const auto key = nearest[i] ? std::pair(static_cast<std::int64_t>(*nearest[i]), true)
                                : std::pair(static_cast<std::int64_t>(times[i].count()), false);
    const auto [user, is_new] = users.emplace(key, i);
    if (is_new || scans[user->second].name == scans[i].name) continue;
    if (pairs++ > 0) continue;
    const bool same_time = times[user->second] == times[i];
    first = scans[user->second].name + " and " + scans[i].name +
            (same_time ? " have the same time, " + timeText(times[i])
                       : " get the same pose, that of line " + std::to_string(entry(*nearest[i]).line));
  }
  if (pairs == 0) return;
  matched.warnings.push_back(file_.path.string() + ": the scans " + first +
                             (pairs > 1 ? " (and " + std::to_string(pairs - 1) + " more)" : "") +
                             ". Check the times in the names.");
}

void PoseTimes::match(const std::vector<Instant>& times, const std::vector<ScanKey>& scans, const PoseMatching& options,
                      MatchedPoses& matched) const {
  const Limits limits = this->limits(times, options);
  std::vector<std::optional<std::size_t>> taken(times.size());  // the entries whose poses are used unchanged
  Instant largest(0), most(0);
  LargestMotion motion;
  std::size_t outside = 0, first_outside = 0;    // scans clearly before the first pose or behind the last one
  std::pair<Instant, std::size_t> widest(0, 0);  // the largest gap between interpolated poses, and its scan
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::size_t near = nearest(times[i]);
    const std::optional<Step> step = stepAt(times[i]);
    const bool between_poses = times[i] >= time(0) && times[i] <= time(order_.size() - 1);
    const Instant limit = between_poses && options.interpolate && step ? limits.interpolated : limits.nearest;
    const Instant gap = between(times[i], time(near));
    requireOne(near);
    if (gap > limit) {
      const bool can_interpolate = !options.interpolate && between_poses && step && gap <= limits.interpolated;
      matched.missing.push_back({i, shortTime(gap) + " from the nearest pose, at most " + shortTime(limit) +
                                        (can_interpolate ? "; with --interpolate it has a pose" : "")});
      continue;
    }
    largest = std::max(largest, gap);
    most = std::max(most, limit);
    if (!between_poses && gap > limits.outside && outside++ == 0) first_outside = i;
    if (options.interpolate && step && time(step->after) - time(step->before) <= 4 * limit) {
      matched.poses[i] = interpolate(*entry(step->before).pose, *entry(step->after).pose, step->share);
      if (const Instant width = time(step->after) - time(step->before); gap > limits.usual && width > widest.first)
        widest = {width, i};
      continue;
    }
    matched.poses[i] = entry(near).pose;
    if (!matched.poses[i]) {
      matched.missing.push_back({i, "line " + std::to_string(entry(near).line) + " has no pose (NaN)"});
      continue;
    }
    taken[i] = near;
    if (step)
      motion.add(*matched.poses[i], interpolate(*entry(step->before).pose, *entry(step->after).pose, step->share), i);
  }
  warnOfSharedPoses(times, scans, taken, matched);
  if (outside > 0)
    matched.warnings.push_back(file_.path.string() + ": " + scans[first_outside].name +
                               (outside > 1 ? " and " + std::to_string(outside - 1) + " more" : "") +
                               (outside > 1 ? " are " : " is ") + "outside the times of the poses, by " +
                               shortTime(between(times[first_outside], time(nearest(times[first_outside])))) +
                               ", and used with the nearest pose. Use a smaller --max-time-gap to refuse that.");
  if (widest.first > Instant(0))
    matched.warnings.push_back(file_.path.string() + ": " + scans[widest.second].name +
                               " is interpolated between poses " + shortTime(widest.first) +
                               " apart, because a pose is missing there");
  matched.how = "matched by time, " + std::string(options.interpolate ? "interpolated, " : "") + "at most " +
                shortTime(largest) + " apart (limit " + shortTime(most) + ")";
  if (motion.noticed()) {
    std::ostringstream text;
    text.precision(2);
    text << file_.path.string() << ": the pose nearest in time is up to " << motion.metres << " m and "
         << motion.turn * 180.0 / std::acos(-1.0) << " degrees from the interpolated pose (" << scans[motion.scan].name
         << "). " << (options.interpolate ? "The poses have a gap there." : "Use --interpolate.");
    matched.warnings.push_back(text.str());
  }
  if (matched.missing.size() == times.size() && !times.empty()) {
    const auto [low, high] = std::minmax_element(times.begin(), times.end());
    matched.how = "by time; the times of the scans are from " + timeText(*low) + " to " + timeText(*high) +
                  ", those of the poses from " + timeText(time(0)) + " to " + timeText(time(order_.size() - 1));
  }
}

}  // namespace gaussmap::detail
