// SPDX-License-Identifier: BSD-3-Clause
#include "segments/level_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/about_z.h"
#include "core/number_text.h"
#include "gaussmap/core/error.h"

namespace gaussmap::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The range of some heights [m].
struct Heights {
  double lowest = kInfinity, highest = -kInfinity;

  void add(double height) {
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  bool arePlanar() const { return !(highest - lowest > kMaxPlanarHeight); }
};

/// Returns true if a rotation turns about z only.
bool isAboutZ(const Pose::Rotation& rotation) {
  return rotation.x() == 0.0 && rotation.y() == 0.0;
}

class HeightCheckedReader : public ScanReader {
 public:
  HeightCheckedReader(std::unique_ptr<ScanReader> reader, ScanInfo scan, ScanFrame frame)
      : reader_(std::move(reader)), scan_(std::move(scan)) {
    // Height of a point: a row of the rotation, and the height of the sensor.
    if (frame == ScanFrame::Map) return;
    up_ = scan_.pose.rotation.toRotationMatrix().row(2);
    sensor_ = scan_.pose.translation.z();
  }

  std::size_t size() const override { return reader_->size(); }
  int columns() const override { return reader_->columns(); }
  void read(std::size_t first, PointBlock<3>& block) const override {
    reader_->read(first, block);
    Heights heights;
    for (std::size_t i = 0; i < block.size; ++i) {
      const Eigen::Vector3d point(block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]);
      if (isReturn(point)) heights.add(up_.dot(point) + sensor_);
    }
    const std::lock_guard lock(mutex_);
    heights_.lowest = std::min(heights_.lowest, heights.lowest);
    heights_.highest = std::max(heights_.highest, heights.highest);
  }
  void requireWhole() const override {
    reader_->requireWhole();
    const std::lock_guard lock(mutex_);
    if (!heights_.arePlanar()) throw FileError(scan_.name, notPlanarText(heights_.lowest, heights_.highest));
  }
  std::vector<std::string> valueNames() const override { return reader_->valueNames(); }
  std::vector<double> values(const std::string& name) const override { return reader_->values(name); }

 private:
  std::unique_ptr<ScanReader> reader_;
  ScanInfo scan_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
  double sensor_ = 0.0;
  mutable std::mutex mutex_;  // blocks of a scan are read in parallel
  mutable Heights heights_;
};

}  // namespace

std::string notPlanarText(double lowest, double highest) {
  const auto millimetres = [](double height) { return numberText(std::round(1e3 * height) / 1e3 + 0.0); };  // not "-0"
  return "not a scan of a planar laser: the heights of its points in the map are " + millimetres(lowest) + " m to " +
         millimetres(highest) + " m; use a slice of it (--slice Z0 Z1)";
}

Scan levelled(const Scan& scan, const PlanarScanOptions& options) {
  const Eigen::Matrix3d rotation = scan.pose.rotation.toRotationMatrix();
  const double heading = std::atan2(rotation(1, 0), rotation(0, 0));
  const bool is_level = isAboutZ(scan.pose.rotation);
  Scan level = scan;
  level.pose.translation.z() = 0.0;
  if (!is_level) level.pose.rotation = aboutZ(heading);
  const Eigen::Matrix3d to_level = level.pose.rotation.toRotationMatrix().transpose() * rotation;
  Heights heights;
  for (Eigen::Vector3d& point : level.points) {
    if (!isReturn(point)) continue;
    const double height = rotation.row(2).dot(point) + scan.pose.translation.z();
    heights.add(height);
    if (!is_level) point = to_level * point;
    point.z() = 0.0;
    if (options.slice && !(height >= options.z_min && height <= options.z_max))
      point.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  if (!options.slice && !heights.arePlanar())
    throw std::invalid_argument(notPlanarText(heights.lowest, heights.highest));
  return level;
}

Pose poseOf(const LaserScan& beams) {
  return {{beams.pose.translation.x(), beams.pose.translation.y(), 0.0}, aboutZ(beams.pose.heading)};
}

Eigen::Vector3d pointOf(const LaserScan& beams, std::size_t beam) {
  if (!beams.returned(beam)) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const double range = beams.ranges[beam], bearing = beams.bearings[beam];
  return {range * std::cos(bearing), range * std::sin(bearing), 0.0};
}

Scan scanOfBeams(const LaserScan& beams) {
  Scan scan;
  scan.pose = poseOf(beams);
  scan.time = beams.time;
  scan.points.reserve(beams.ranges.size());
  for (std::size_t i = 0; i < beams.ranges.size(); ++i) scan.points.push_back(pointOf(beams, i));
  return scan;
}

std::unique_ptr<ScanReader> PlanarLaserScans::open(std::size_t index) const {
  return std::make_unique<HeightCheckedReader>(scans_.open(index), scans_.info(index), scans_.frame());
}

}  // namespace gaussmap::detail
