// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "core/parallel.h"
#include "core/pi.h"
#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kGrain = 16;  // columns per task
constexpr double kGrazing = 1e-4;

template <typename Options>
void checkRanges(const Options& options) {
  require(options.noise >= 0.0 && std::isfinite(options.noise), "noise", options.noise,
          "must be finite and not negative");
  require(options.max_range > 0.0, "max_range", options.max_range, "must be positive");
}

void checkOptions(const LidarOptions& options) {
  require(options.rings >= 1, "rings", options.rings, "must be at least 1");
  require(options.columns >= 1, "columns", options.columns, "must be at least 1");
  require(options.lowest_deg > -90.0, "lowest_deg", options.lowest_deg, "must be above -90 degrees");
  require(options.lowest_deg <= options.highest_deg && options.highest_deg < 90.0, "highest_deg", options.highest_deg,
          "must be at least lowest_deg and below 90 degrees");
  checkRanges(options);
}

void checkOptions(const PlanarLaserOptions& options) {
  require(options.beams >= 1, "beams", options.beams, "must be at least 1");
  require(options.field_deg > 0.0 && options.field_deg <= 360.0, "field_deg", options.field_deg,
          "must be above 0 and at most 360 degrees");
  checkRanges(options);
}

int columns(const LidarOptions& options) {
  return options.columns;
}
int columns(const PlanarLaserOptions& options) {
  return options.beams;
}
int rings(const LidarOptions& options) {
  return options.rings;
}
int rings(const PlanarLaserOptions&) {
  return 1;
}

/// Returns the unit vector of one laser, sensor frame.
Eigen::Vector3d beam(const LidarOptions& options, int ring, int column) {
  const double step = options.rings > 1 ? (options.highest_deg - options.lowest_deg) / (options.rings - 1) : 0.0;
  const double elevation = (options.lowest_deg + ring * step) * kDegree;
  const double azimuth = 360.0 * column / options.columns * kDegree;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

Eigen::Vector3d beam(const PlanarLaserOptions& options, int, int number) {
  const int steps = options.field_deg < 360.0 ? options.beams - 1 : options.beams;
  const double bearing = steps > 0 ? options.field_deg * (double(number) / steps - 0.5) * kDegree : 0.0;
  return {std::cos(bearing), std::sin(bearing), 0.0};
}

template <typename Options>
SimulatedScan scanWorld(const World& world, const Pose& sensor_pose, const Options& options, std::uint64_t seed,
                        double time) {
  checkOptions(options);
  if (!std::isfinite(time)) throw std::invalid_argument("the time of a scan is not finite");
  if (const std::string fault = poseFault(sensor_pose); !fault.empty())
    throw std::invalid_argument("sensor pose: " + fault);
  SimulatedScan scan;
  scan.pose = normalised(sensor_pose);
  const Eigen::Matrix3d rotation = scan.pose.rotation.toRotationMatrix();

  std::vector<SimulatedScan> parts(static_cast<std::size_t>(columns(options)));
  parallelFor(parts.size(), options.threads, kGrain, [&](std::size_t column) {
    SimulatedScan& part = parts[column];
    Random random = Random::forPart(seed, column);
    for (int ring = 0; ring < rings(options); ++ring) {
      const Eigen::Vector3d direction = beam(options, ring, static_cast<int>(column));
      const Ray ray{scan.pose.translation, rotation * direction};
      const double noise = options.noise * random.normal();  // for every ray, so a new object changes no other noise
      const std::optional<World::Hit> hit = world.intersect(ray, time, options.max_range);
      if (!hit || hit->cosine < kGrazing || hit->range > options.max_range || hit->range + noise <= 0.0) continue;
      part.points.emplace_back((hit->range + noise) * direction);
      part.truth.emplace_back(ray.origin + hit->range * ray.direction);
      part.labels.push_back(hit->label);
    }
  });
  for (const SimulatedScan& part : parts) {
    scan.points.insert(scan.points.end(), part.points.begin(), part.points.end());
    scan.truth.insert(scan.truth.end(), part.truth.begin(), part.truth.end());
    scan.labels.insert(scan.labels.end(), part.labels.begin(), part.labels.end());
  }
  return scan;
}

}  // namespace

SimulatedScan simulateScan(const World& world, const Pose& sensor_pose, const LidarOptions& options, std::uint64_t seed,
                           double time) {
  return scanWorld(world, sensor_pose, options, seed, time);
}

SimulatedScan simulateScan(const World& world, const Pose& sensor_pose, const PlanarLaserOptions& options,
                           std::uint64_t seed, double time) {
  return scanWorld(world, sensor_pose, options, seed, time);
}

}  // namespace gaussmap
