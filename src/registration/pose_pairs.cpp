// SPDX-License-Identifier: BSD-3-Clause
#include "registration/pose_pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gaussmap::detail {
namespace {

using Pair = std::pair<std::size_t, std::size_t>;

constexpr std::size_t kAnchors = 16;  // first scans of pairs that are tried per part of the sequence
constexpr std::size_t kSteps[] = {1, 2, 3, 5, 8, 12, 20, 32};
// As parts of the radius: two motions are clearly different, or not different.
constexpr double kClear = 0.15, kSame = 0.01;
// In units of clear pairs: a convention is told from the given one, or another pair is worth its time.
constexpr double kTold = 1.0, kWorthAnother = 0.2;

using Shares = std::array<double, kPoseConventions.size()>;

/// Returns how clearly a pair tells each convention from the given one: from 0 to 1.
Shares clearness(const ReadPoses& read, const Pair& pair, PoseConvention given, const ScanExtent& extent) {
  const auto [to, from] = pair;
  const Pose expected = motionBetween(given, read, to, from);
  Shares shares{};
  for (std::size_t c = 0; c < shares.size(); ++c) {
    const double apart =
        separation(expected, motionBetween(kPoseConventions[c], read, to, from), extent) / extent.radius;
    if (apart > kSame) shares[c] = std::min(1.0, apart / kClear);
  }
  return shares;
}

/// Returns the distance of two scans as a part of their radius, for the convention in which they are nearest.
double distanceOf(const ReadPoses& read, const Pair& pair, const ScanExtent& extent) {
  double least = std::numeric_limits<double>::infinity();
  for (const PoseConvention convention : kPoseConventions)
    if (convention != PoseConvention::NoMotion)
      least = std::min(
          least, (motionBetween(convention, read, pair.first, pair.second) * extent.centre - extent.centre).norm());
  return least / extent.radius;
}

/// Returns how much a pair tells, from 0 on. What earlier pairs told counts less.
double worthOf(const Shares& shares, const Shares& told) {
  double worth = 0.0;
  for (std::size_t c = 0; c < shares.size(); ++c) worth += shares[c] / (1.0 + told[c]);
  return worth;
}

/// Returns how much scans at this distance overlap, from 0 to 1.
double overlapOf(double distance) {
  return 1.0 / (1.0 + 0.5 * distance) / std::max(1.0, distance);
}

/// A pair of scans, how clearly it tells each convention, and how good it is.
struct Candidate {
  Pair pair;
  Shares shares{};
  double worth = 0.0;
};

}  // namespace

Pose motionBetween(PoseConvention convention, const ReadPoses& read, std::size_t to, std::size_t from) {
  if (convention == PoseConvention::NoMotion) return {};
  const Pose target = poseAs(convention, read.poses[to]) * read.extrinsic;
  return target.inverse() * (poseAs(convention, read.poses[from]) * read.extrinsic);
}

double separation(const Pose& a, const Pose& b, const ScanExtent& extent) {
  const double angle = Eigen::Quaterniond(a.rotation).angularDistance(Eigen::Quaterniond(b.rotation));
  return (a * extent.centre - b * extent.centre).norm() + angle * extent.radius;
}

std::vector<Pair> tellingPairs(const ReadPoses& read, PoseConvention given, const ScanExtent& extent,
                               std::size_t most) {
  std::vector<Pair> pairs;
  if (read.poses.size() < 2 || !(extent.radius > 0.0)) return pairs;
  const std::size_t last = read.poses.size() - 1, parts = std::min(most, last);
  std::vector<Candidate> rare(kPoseConventions.size());
  Shares told{};
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * last / parts, end = (part + 1) * last / parts;
    const std::size_t stride = std::max<std::size_t>(1, (end - begin) / kAnchors);
    Candidate best;
    for (std::size_t i = begin; i < end; i += stride) {
      for (const std::size_t step : kSteps) {
        if (i + step > last) break;
        const Pair pair{i, i + step};
        Candidate candidate{pair, clearness(read, pair, given, extent), 0.0};
        const double overlap = overlapOf(distanceOf(read, pair, extent));
        for (std::size_t c = 0; c < told.size(); ++c) {
          candidate.worth = candidate.shares[c] * overlap;
          if (candidate.worth > rare[c].worth) rare[c] = candidate;
        }
        candidate.worth = worthOf(candidate.shares, told) * overlap;
        if (candidate.worth > best.worth) best = candidate;
      }
    }
    if (best.worth == 0.0) continue;
    pairs.push_back(best.pair);
    for (std::size_t c = 0; c < told.size(); ++c) told[c] += best.shares[c];
  }
  // One more pair for each convention that these pairs hardly tell from the given one.
  for (std::size_t c = 0; c < told.size(); ++c) {
    if (told[c] >= kTold || rare[c].shares[c] < kWorthAnother) continue;
    if (std::find(pairs.begin(), pairs.end(), rare[c].pair) != pairs.end()) continue;
    pairs.push_back(rare[c].pair);
    for (std::size_t other = 0; other < told.size(); ++other) told[other] += rare[c].shares[other];
  }
  return pairs;
}

}  // namespace gaussmap::detail
