// SPDX-License-Identifier: BSD-3-Clause
#include "core/accept_points.h"

#include <cmath>
#include <limits>

namespace gaussmap::detail {
namespace {

enum class PointKind { Accepted, NonFinite, AtSensor, BeyondRange };

/// Classifies a point by its squared range from the sensor, which is infinite for some finite points.
PointKind kindOf(double square_range, bool finite, double square_max) {
  if (!finite) return PointKind::NonFinite;
  if (square_range == 0.0) return PointKind::AtSensor;
  return square_range > square_max ? PointKind::BeyondRange : PointKind::Accepted;
}

bool isFinitePoint(const PointBlock<3>& block, std::size_t i) {
  return std::isfinite(block.coordinate[0][i]) && std::isfinite(block.coordinate[1][i]) &&
         std::isfinite(block.coordinate[2][i]);
}

void count(PointKind kind, PointCounts& counts) {
  counts.accepted += kind == PointKind::Accepted;
  counts.non_finite += kind == PointKind::NonFinite;
  counts.at_sensor += kind == PointKind::AtSensor;
  counts.beyond_range += kind == PointKind::BeyondRange;
}

}  // namespace

PointCounts acceptPoints(const Pose& pose, ScanFrame frame, double max_range, PointBlock<3>& block) {
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
    const PointKind kind = kindOf(square_range[i], finite, max_range * max_range);
    count(kind, counts);
    kept += kind == PointKind::Accepted;
  }
  block.size = kept;
  if (in_sensor_frame) transform(pose, block);
  return counts;
}

PointCounts dropPoints(double max_range, Scan& scan) {
  PointCounts counts;
  counts.read = static_cast<std::int64_t>(scan.points.size());
  for (Eigen::Vector3d& point : scan.points) {
    const PointKind kind = kindOf(point.squaredNorm(), point.allFinite(), max_range * max_range);
    count(kind, counts);
    if (kind != PointKind::Accepted) point.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return counts;
}

}  // namespace gaussmap::detail
