// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/simulation/lidar.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "common/parallel.h"
#include "gaussmap/gaussian/random.h"

namespace gaussmap {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

void checkOptions(const LidarOptions& options) {
  const auto require = [](bool usable, const std::string& what) {
    if (!usable) throw std::invalid_argument("lidar: " + what);
  };
  require(options.rings >= 1, "rings = " + std::to_string(options.rings) + ": at least one is needed");
  require(options.columns >= 1, "columns = " + std::to_string(options.columns) + ": at least one is needed");
  require(options.lowest_deg > -90.0 && options.lowest_deg <= options.highest_deg && options.highest_deg < 90.0,
          "elevations from " + std::to_string(options.lowest_deg) + " to " + std::to_string(options.highest_deg) +
              " degrees: must be within (-90, 90) and ascending");
  require(options.noise >= 0.0 && std::isfinite(options.noise),
          "noise = " + std::to_string(options.noise) + ": must be a number of metres, not negative");
  require(options.max_range > 0.0, "max_range = " + std::to_string(options.max_range) + ": must be positive");
}

/// Unit vector of one laser, sensor frame.
Eigen::Vector3d beam(const LidarOptions& options, int ring, int column) {
  const double step = options.rings > 1 ? (options.highest_deg - options.lowest_deg) / (options.rings - 1) : 0.0;
  const double elevation = (options.lowest_deg + ring * step) * kDegree;
  const double azimuth = 360.0 * column / options.columns * kDegree;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

}  // namespace

SimulatedScan simulateScan(const Scene& scene, const Pose& sensor_pose, const LidarOptions& options,
                           std::uint64_t seed) {
  checkOptions(options);
  checkScene(scene);
  if (const std::string fault = poseFault(sensor_pose); !fault.empty())
    throw std::invalid_argument("sensor pose: " + fault);
  SimulatedScan scan;
  scan.pose = normalised(sensor_pose);
  const Eigen::Matrix3d rotation = scan.pose.rotation.toRotationMatrix();

  std::vector<SimulatedScan> columns(static_cast<std::size_t>(options.columns));
  parallelFor(columns.size(), options.threads, 16, [&](std::size_t column) {
    Random random = Random::forPart(seed, column);
    for (int ring = 0; ring < options.rings; ++ring) {
      const Eigen::Vector3d direction = beam(options, ring, static_cast<int>(column));
      const Ray ray{scan.pose.translation, rotation * direction};
      const double noise = options.noise * random.normal();  // drawn for every ray: a new object moves no other point
      const std::optional<double> range = scene.intersect(ray);
      if (!range || *range > options.max_range || *range + noise <= 0.0) continue;
      columns[column].points.emplace_back((*range + noise) * direction);
      columns[column].truth.emplace_back(ray.origin + *range * ray.direction);
    }
  });
  for (const SimulatedScan& column : columns) {
    scan.points.insert(scan.points.end(), column.points.begin(), column.points.end());
    scan.truth.insert(scan.truth.end(), column.truth.begin(), column.truth.end());
  }
  return scan;
}

}  // namespace gaussmap
