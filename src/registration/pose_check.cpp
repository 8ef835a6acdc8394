// SPDX-License-Identifier: BSD-3-Clause
#include "registration/pose_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/parallel.h"
#include "core/same_pose.h"
#include "registration/scan_surfaces.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kConventions = kPoseConventions.size();
constexpr std::size_t kNoMotion = std::size_t(PoseConvention::NoMotion);
constexpr double kFinest = 1.0 / 16.0;  // side of the finest cells, as a part of the radius of a scan
constexpr double kSlack = 0.1;          // distance from a surface that counts as on it, as a part of the side
constexpr double kClearOffset = 3.0;    // two places differ, in units of that distance
// A piece counts if the offset along its normal is at least this part of the whole offset. Without this limit, the
// errors of odometry would decide about the floor, whose distance from the sensor never changes.
constexpr double kClearPart = 0.25;
constexpr double kBody = 0.6;  // range in which a sensor can see its carrier, as a part of the radius
// Share of the pieces on surfaces. Measured for right poses: 0.74 or more on 15 sequences, see gaussmap_benchmark
// pose-check; for right alternatives 0.62 or more.
constexpr double kGoodFit = 0.6, kBadFit = 0.5;
constexpr std::size_t kFewestMet = 100;    // pieces, to say that scans do not fit
constexpr double kSameDirection = 0.906;   // cosine of 25 degrees
constexpr double kOtherDirection = 0.766;  // cosine of 40 degrees

constexpr std::size_t indexOf(PoseConvention convention) {
  return std::size_t(convention);  // the order of kPoseConventions
}

using Duels = std::array<std::array<ConventionDuel, kConventions>, kConventions>;

/// Returns at most `most` returns of a scan, spread evenly over it, in the frame of Scans::frame().
std::vector<Eigen::Vector3d> sampleOf(const Scans& scans, std::size_t index, std::size_t most) {
  const std::unique_ptr<ScanReader> reader = scans.open(index);
  std::vector<Eigen::Vector3d> points;
  const std::size_t size = reader->size();
  const double step = std::max(1.0, double(size) / double(most));
  points.reserve(std::min(size, most));
  // One point per interval, at a place in it that varies: a fixed place could select one ring of a lidar.
  std::uint32_t random = 1;
  std::size_t taken = 0;
  const auto next = [&] {
    random = random * 1664525u + 1013904223u;
    const double shift = step > 1.0 ? (step - 1.0) * double(random >> 8) / double(1u << 24) : 0.0;
    return std::size_t(double(taken) * step + shift);
  };
  std::size_t wanted = next();
  PointBlock<3> block;
  while (wanted < size) {
    const std::size_t first = wanted / PointBlock<3>::kCapacity * PointBlock<3>::kCapacity;
    reader->read(first, block);
    if (block.size == 0) break;
    for (; wanted < first + block.size; ++taken, wanted = next()) {
      const std::size_t i = wanted - first;
      const Eigen::Vector3d point(block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]);
      if (isReturn(point)) points.push_back(point);
    }
  }
  return points;
}

/// Returns the number of pairs to compare: more pairs if the scans have few points, which is cheap then.
std::size_t pairsFor(std::size_t points, const PoseCheckOptions& options) {
  return std::max(options.pairs,
                  std::min(3 * options.pairs, options.points_per_scan / std::max<std::size_t>(points, 1)));
}

double sideOf(const Surface& surface, const ScanSurfaces& scan) {
  return scan.finest() * double(1 << surface.level);
}

/// Where a piece lies in another scan.
enum class Place { Empty, Beside, On };

/// Returns where the piece, moved by `motion`, lies in `target`.
Place placeOf(const Surface& piece, double side, const Pose& motion, const Eigen::Matrix3d& rotation,
              const ScanSurfaces& target) {
  const Eigen::Vector3d mean = rotation * piece.mean + motion.translation;
  const Eigen::Vector3d normal = rotation * piece.normal;
  const Eigen::Vector3d along = target.planar() ? Eigen::Vector3d(rotation * piece.normal.cross(piece.across)) : normal;
  Place place = Place::Empty;
  for (int level = std::max(0, piece.level - 2); level <= std::min(ScanSurfaces::kLevels - 1, piece.level + 1);
       ++level) {
    const Surface* const surface = target.at(mean, level);
    if (surface == nullptr) continue;
    place = Place::Beside;
    const double limit =
        kSlack * std::max(side, sideOf(*surface, target)) + 2.0 * std::hypot(piece.thickness, surface->thickness);
    const Eigen::Vector3d offset = mean - surface->mean;
    const Eigen::Vector3d direction =
        target.planar() ? Eigen::Vector3d(surface->normal.cross(surface->across)) : surface->normal;
    if (std::abs(along.dot(direction)) < kSameDirection) continue;
    if (std::abs(offset.dot(surface->normal)) > limit || std::abs(offset.dot(surface->across)) > limit) continue;
    return Place::On;
  }
  return place;
}

/// Returns true if two motions put the piece at clearly different places: not onto the same plane.
bool tells(const Surface& piece, double side, const Pose& a, const Pose& b) {
  const Eigen::Vector3d offset = a * piece.mean - b * piece.mean;
  const double limit = std::max(kClearOffset * (kSlack * side + 2.0 * piece.thickness), kClearPart * offset.norm());
  const Eigen::Vector3d normal_a = a.rotation * piece.normal, normal_b = b.rotation * piece.normal;
  if (std::abs(normal_a.dot(normal_b)) < kOtherDirection) return true;
  if (std::min(std::abs(offset.dot(normal_a)), std::abs(offset.dot(normal_b))) > limit) return true;
  if (piece.across.isZero(0.0)) return false;
  const Eigen::Vector3d across_a = a.rotation * piece.across, across_b = b.rotation * piece.across;
  return std::abs(across_a.dot(across_b)) < kOtherDirection ||
         std::min(std::abs(offset.dot(across_a)), std::abs(offset.dot(across_b))) > limit;
}

/// Returns true if a motion keeps a planar scan in its plane, near a piece.
bool staysInPlane(const Surface& piece, double side, const Pose& motion) {
  const Eigen::Vector3d offset = motion * piece.mean - piece.mean;
  return std::abs(offset.dot(piece.across)) <= kSlack * side &&
         std::abs((motion.rotation * piece.across).dot(piece.across)) > kSameDirection;
}

/// What one pair of scans says.
struct PairResult {
  Duels duels;
  std::array<ConventionFit, kConventions> fits;
};

/// Adds the duels of the pieces of `source` on `target`. `motions`: of the points of `source` into the frame of
/// `target`, per convention.
void addDuels(const ScanSurfaces& source, const ScanSurfaces& target, const std::array<Pose, kConventions>& motions,
              std::size_t given, PairResult& result) {
  std::array<Eigen::Matrix3d, kConventions> rotations;
  for (std::size_t c = 0; c < kConventions; ++c) rotations[c] = motions[c].rotation.toRotationMatrix();
  for (const Surface& piece : source.surfaces()) {
    if (piece.covered) continue;
    const double side = sideOf(piece, source);
    std::array<bool, kConventions> fits;
    // The body of the robot moves with the sensor.
    const bool carried = piece.mean.norm() < kBody * source.finest() / kFinest;
    for (std::size_t c = 0; c < kConventions; ++c) {
      const Place place = placeOf(piece, side, motions[c], rotations[c], target);
      fits[c] = place == Place::On;
      if (carried) continue;
      result.fits[c].met += place != Place::Empty;
      result.fits[c].on += fits[c];
    }
    // The slices of a planar laser that moves out of its plane look alike, but show different places.
    const bool slices = source.planar() && !staysInPlane(piece, side, motions[given]);
    for (std::size_t a = 0; a < kConventions; ++a)
      for (std::size_t b = a + 1; b < kConventions; ++b) {
        if (!tells(piece, side, motions[a], motions[b])) continue;
        if (carried && (a == kNoMotion || b == kNoMotion)) continue;
        if (slices && ((a == given && b == kNoMotion) || (b == given && a == kNoMotion))) continue;
        for (const auto& [first, other] : {std::pair(a, b), std::pair(b, a)})
          result.duels[first][other] +=
              {1, std::size_t(fits[first] && !fits[other]), std::size_t(fits[other] && !fits[first]),
               std::size_t(fits[first] && fits[other])};
      }
  }
}

/// Returns true if another convention wins with a clear margin. `pairs`: pairs of scans that tell the two apart.
bool winsClearly(const ConventionDuel& duel, std::size_t pairs) {
  const double share = duel.pieces > 0 ? double(duel.other_only) / double(duel.pieces) : 0.0;
  // Few pieces that fit could fit by chance, so they must be nearly all.
  const std::size_t margin = share >= 0.1 ? 3 : 8;
  return share >= (pairs > 1 ? 0.05 : 0.08) && duel.other_only >= margin * duel.first_only + 8;
}

/// Returns the convention that wins against the given one. `never`: a convention that the poses cannot have.
std::optional<std::size_t> betterThan(std::size_t given, const std::vector<PairResult>& per_pair, const Duels& sum,
                                      const std::vector<ConventionFit>& fits, std::optional<PoseConvention> never) {
  std::optional<std::size_t> best;
  for (std::size_t c = 0; c < kConventions; ++c) {
    if (c == given || kPoseConventions[c] == never || fits[c].share() < kGoodFit) continue;
    std::size_t told = 0, won = 0;
    for (const PairResult& pair : per_pair) {
      const ConventionDuel& duel = pair.duels[given][c];
      if (duel.first_only + duel.other_only < 5) continue;
      ++told;
      won += duel.other_only > 2 * duel.first_only;
    }
    if (told == 0 || 3 * won < 2 * told || !winsClearly(sum[given][c], told)) continue;
    const auto loses = [&](std::size_t other) {
      return sum[c][other].other_only > sum[c][other].first_only + sum[c][other].pieces / 20;
    };
    bool lost = false;
    for (std::size_t other = 0; other < kConventions; ++other)
      lost = lost || (other != c && kPoseConventions[other] != never && loses(other));
    // The first of two conventions that the scans hardly distinguish stays.
    if (!lost && (!best || sum[*best][c].other_only > sum[*best][c].first_only + sum[*best][c].pieces / 100)) best = c;
  }
  return best;
}

}  // namespace

ConventionDuel& ConventionDuel::operator+=(const ConventionDuel& more) {
  pieces += more.pieces;
  first_only += more.first_only;
  other_only += more.other_only;
  both += more.both;
  return *this;
}

PoseCheck checkPoses(const Scans& scans, const PoseCheckOptions& options) {
  PoseCheck result;
  result.given = scans.frame() == ScanFrame::Map ? PoseConvention::NoMotion : options.convention;
  if (scans.size() < 2) return result;
  ReadPoses read;
  if (options.read)
    read = *options.read;
  else
    for (std::size_t i = 0; i < scans.size(); ++i) read.poses.push_back(scans.info(i).pose);
  const std::vector<Pose>& poses = read.poses;
  if (poses.size() != scans.size())
    throw std::invalid_argument("read: " + std::to_string(poses.size()) + " poses for " + std::to_string(scans.size()) +
                                " scans");
  if (std::all_of(poses.begin(), poses.end(), [&](const Pose& pose) { return samePose(pose, poses.front()); }))
    return result;

  const std::size_t middle = scans.size() / 2;
  std::map<std::size_t, std::vector<Eigen::Vector3d>> samples;
  samples[middle] = sampleOf(scans, middle, options.points_per_scan);
  if (samples[middle].empty()) return result;
  ScanExtent extent;
  extent.centre = medianOf(samples[middle]);
  extent.radius = medianDistance(samples[middle], extent.centre);
  const auto pairs = tellingPairs(read, result.given, extent, pairsFor(samples[middle].size(), options));
  if (pairs.empty()) return result;

  std::vector<std::size_t> used;
  for (const auto& [to, from] : pairs) used.insert(used.end(), {to, from});
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<ScanSurfaces> surfaces(used.size());
  parallelFor(used.size(), options.threads, 1, [&](std::size_t i) {
    const auto known = samples.find(used[i]);
    const std::vector<Eigen::Vector3d> points =
        known != samples.end() ? known->second : sampleOf(scans, used[i], options.points_per_scan);
    if (!points.empty()) surfaces[i] = {points, kFinest * extent.radius, planeOf(points, extent.radius)};
  });

  const std::size_t given = indexOf(result.given);
  std::vector<PairResult> per_pair(pairs.size());
  parallelFor(pairs.size(), options.threads, 1, [&](std::size_t i) {
    const auto [to, from] = pairs[i];
    const ScanSurfaces& a = surfaces[std::size_t(std::lower_bound(used.begin(), used.end(), to) - used.begin())];
    const ScanSurfaces& b = surfaces[std::size_t(std::lower_bound(used.begin(), used.end(), from) - used.begin())];
    if (a.planar() != b.planar()) return;
    std::array<Pose, kConventions> motions, back;
    for (std::size_t c = 0; c < kConventions; ++c) {
      motions[c] = motionBetween(kPoseConventions[c], read, to, from);
      back[c] = motions[c].inverse();
    }
    addDuels(b, a, motions, given, per_pair[i]);
    addDuels(a, b, back, given, per_pair[i]);
  });
  Duels sum;
  result.fits.resize(kConventions);
  for (const PairResult& pair : per_pair)
    for (std::size_t a = 0; a < kConventions; ++a) {
      result.fits[a].met += pair.fits[a].met;
      result.fits[a].on += pair.fits[a].on;
      for (std::size_t b = 0; b < kConventions; ++b) sum[a][b] += pair.duels[a][b];
    }
  result.pairs = pairs.size();
  for (const auto& row : sum) result.duels.emplace_back(row.begin(), row.end());
  if (const auto better = betterThan(given, per_pair, sum, result.fits, options.never)) {
    result.better = kPoseConventions[*better];
    result.duel = sum[given][*better];
  } else {
    result.doubtful = result.fits[given].met >= kFewestMet && result.fits[given].share() < kBadFit;
  }
  return result;
}

}  // namespace gaussmap::detail
