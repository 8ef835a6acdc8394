// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/path.h"
#include "core/pi.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace gaussmap::simulation {
namespace {

constexpr int kRoundings = 3;
constexpr double kLook = 0.3;  // the direction of the path is taken from this far behind to this far ahead [m]

/// Returns the line with each corner cut off, at a quarter of its two sides (Chaikin).
std::vector<Eigen::Vector2d> cornersCut(const std::vector<Eigen::Vector2d>& line) {
  std::vector<Eigen::Vector2d> cut{line.front()};
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    cut.emplace_back(0.75 * line[i] + 0.25 * line[i + 1]);
    cut.emplace_back(0.25 * line[i] + 0.75 * line[i + 1]);
  }
  cut.push_back(line.back());
  return cut;
}

/// Returns the share i / (count - 1); 0 if count is 1.
double part(int i, int count) {
  return count > 1 ? double(i) / (count - 1) : 0.0;
}

}  // namespace

Pose::Rotation turned(double yaw, double pitch, double roll) {
  return Pose::Rotation(Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitX()));
}

Pose chained(const Pose& second, const Pose& first) {
  return second * first;
}

std::vector<TimedPose> drive(const std::vector<Eigen::Vector2d>& waypoints, int count, const PathOptions& options,
                             const Pose& placement) {
  std::vector<Eigen::Vector2d> line = waypoints;
  for (int i = 0; i < kRoundings; ++i) line = cornersCut(line);
  std::vector<double> way{0.0};
  for (std::size_t i = 1; i < line.size(); ++i) way.push_back(way.back() + (line[i] - line[i - 1]).norm());
  const auto place = [&](double along) -> Eigen::Vector2d {
    const auto next = std::upper_bound(way.begin() + 1, way.end() - 1, along);
    const auto piece = static_cast<std::size_t>(next - way.begin()) - 1;
    const double part = std::clamp((along - way[piece]) / (way[piece + 1] - way[piece]), 0.0, 1.0);
    return (1.0 - part) * line[piece] + part * line[piece + 1];
  };

  std::vector<TimedPose> poses;
  for (int i = 0; i < count; ++i) {
    const double along = part(i, count) * way.back();
    const Eigen::Vector2d position = place(along), ahead = place(along + kLook) - place(along - kLook);
    const double yaw = std::atan2(ahead.y(), ahead.x()) / kDegree;
    const double pitch = 0.4 * options.sway * std::sin(0.9 * along + 1.0);
    const double roll = 0.5 * options.sway * std::sin(0.55 * along);
    const Pose pose{{position.x(), position.y(), options.height}, turned(yaw, pitch, roll)};
    poses.push_back({along / options.speed, chained(placement, pose)});
  }
  return poses;
}

std::vector<TimedPose> interpolated(const std::vector<Pose>& poses, int count, double step) {
  std::vector<TimedPose> result;
  for (int i = 0; i < count; ++i) {
    const double place = part(i, count) * static_cast<double>(poses.size() - 1);
    const auto before = static_cast<std::size_t>(place), after = std::min(before + 1, poses.size() - 1);
    const double rest = place - static_cast<double>(before);
    Pose pose = poses[before];
    if (rest > 0.0) {
      pose.translation = (1.0 - rest) * poses[before].translation + rest * poses[after].translation;
      pose.rotation = poses[before].rotation.slerp(rest, poses[after].rotation);
    }
    result.push_back({place * step, pose});
  }
  return result;
}

}  // namespace gaussmap::simulation
