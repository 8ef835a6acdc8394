// SPDX-License-Identifier: BSD-3-Clause
#include "core/accept_points.h"

#include <cmath>
#include <limits>

#include "core/check.h"

namespace gaussmap::detail {
namespace {

enum class PointKind { Accepted, NonFinite, AtSensor, TooNear, BeyondRange, Outside };

/// The limits of the squared range [m^2].
struct SquareRanges {
  double min, max;
};

SquareRanges squareRanges(const PointLimits& limits) {
  return {limits.min_range * limits.min_range, limits.max_range * limits.max_range};
}

/// Classifies a point by its squared range from the sensor, which is infinite for some finite points.
PointKind kindOf(double square_range, bool finite, const SquareRanges& limits) {
  if (!finite) return PointKind::NonFinite;
  if (square_range == 0.0) return PointKind::AtSensor;
  if (square_range < limits.min) return PointKind::TooNear;
  return square_range > limits.max ? PointKind::BeyondRange : PointKind::Accepted;
}

bool isFinitePoint(const PointBlock<3>& block, std::size_t i) {
  return std::isfinite(block.coordinate[0][i]) && std::isfinite(block.coordinate[1][i]) &&
         std::isfinite(block.coordinate[2][i]);
}

void count(PointKind kind, PointCounts& counts) {
  counts.accepted += kind == PointKind::Accepted;
  counts.non_finite += kind == PointKind::NonFinite;
  counts.at_sensor += kind == PointKind::AtSensor;
  counts.too_near += kind == PointKind::TooNear;
  counts.beyond_range += kind == PointKind::BeyondRange;
  counts.outside += kind == PointKind::Outside;
}

/// Drops the points of a block [map frame] that lie outside the box.
void cropBlock(const PointLimits& limits, PointBlock<3>& block, PointCounts& counts) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < block.size; ++i) {
    const Eigen::Vector3d point(block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]);
    for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][kept] = point(axis);
    kept += limits.isInside(point);
  }
  const auto outside = static_cast<std::int64_t>(block.size - kept);
  counts.accepted -= outside;
  counts.outside += outside;
  block.size = kept;
}

}  // namespace

void checkLimits(const PointLimits& limits) {
  require(limits.min_range >= 0.0, "min_range", limits.min_range, "must not be negative");
  require(limits.max_range >= 0.0, "max_range", limits.max_range, "must not be negative");
  for (int axis = 0; axis < 3 && limits.crops; ++axis)
    require(limits.low(axis) < limits.high(axis), "crop", limits.low(axis), "must be below the opposite corner");
}

PointCounts acceptPoints(const Pose& pose, ScanFrame frame, const PointLimits& limits, PointBlock<3>& block) {
  const SquareRanges ranges = squareRanges(limits);
  const bool in_sensor_frame = frame == ScanFrame::Sensor;
  const Eigen::Vector3d origin = in_sensor_frame ? Eigen::Vector3d::Zero() : pose.translation;
  double square_range[PointBlock<3>::kCapacity];
  for (std::size_t i = 0; i < block.size; ++i) {
    const double x = block.coordinate[0][i] - origin.x(), y = block.coordinate[1][i] - origin.y(),
                 z = block.coordinate[2][i] - origin.z();
    square_range[i] = x * x + y * y + z * z;
  }
  PointCounts counts;
  counts.read = static_cast<std::int64_t>(block.size);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < block.size; ++i) {
    for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][kept] = block.coordinate[axis][i];
    const bool finite = std::isfinite(square_range[i]) || isFinitePoint(block, i);
    const PointKind kind = kindOf(square_range[i], finite, ranges);
    count(kind, counts);
    kept += kind == PointKind::Accepted;
  }
  block.size = kept;
  if (in_sensor_frame) transform(pose, block);
  if (limits.crops) cropBlock(limits, block, counts);
  return counts;
}

PointCounts dropPoints(const PointLimits& limits, Scan& scan) {
  const SquareRanges ranges = squareRanges(limits);
  PointCounts counts;
  counts.read = static_cast<std::int64_t>(scan.points.size());
  for (Eigen::Vector3d& point : scan.points) {
    PointKind kind = kindOf(point.squaredNorm(), point.allFinite(), ranges);
    if (kind == PointKind::Accepted && limits.crops && !limits.isInside(scan.pose * point)) kind = PointKind::Outside;
    count(kind, counts);
    if (kind != PointKind::Accepted) point.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return counts;
}

}  // namespace gaussmap::detail
