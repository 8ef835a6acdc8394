// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/laser_scan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/accept_points.h"
#include "core/check.h"
#include "core/pi.h"
#include "core/quantile.h"
#include "gaussmap/core/error.h"
#include "gaussmap/sensor/projection.h"
#include "segments/level_scan.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kNoReturn = std::numeric_limits<double>::quiet_NaN();
constexpr double kGap = 1.5;  // a beam is missing if two beams are more than this many usual steps apart

struct Beam {
  double bearing;  // NaN: not known
  double range;    // NaN: no return
};

void checkOptions(const PlanarScanOptions& options) {
  require(options.step >= 0.01 && options.step <= 180.0, "step", options.step, "must be 0.01 to 180 degrees");
  checkLimits(limitsOf(options));
  if (options.slice)
    require(options.z_min <= options.z_max, "z_max", options.z_max,
            "must be at least z_min, " + numberText(options.z_min) + " m");
}

/// The points as seen from above, and the range of their heights [m].
struct FromAbove {
  std::vector<Beam> beams;  // one per point
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
};

FromAbove lookFromAbove(const Scan& scan, const Pose2& pose, const PlanarScanOptions& options) {
  FromAbove view;
  view.beams.reserve(scan.points.size());
  const Eigen::Matrix3d rotation = scan.pose.rotation.toRotationMatrix();
  const PointLimits limits = limitsOf(options);
  for (const Eigen::Vector3d& point : scan.points) {
    view.beams.push_back({kNoReturn, kNoReturn});
    if (!isReturn(point)) continue;
    const Eigen::Vector3d way = rotation * point;
    const double height = way.z() + scan.pose.translation.z(), range = std::hypot(way.x(), way.y());
    if (options.slice && !(height >= options.z_min && height <= options.z_max)) continue;
    if (!(range > 0.0)) continue;
    const bool is_left_out = range < options.min_range || !limits.isInside(way + scan.pose.translation);
    if (!is_left_out) {
      view.lowest = std::min(view.lowest, height);
      view.highest = std::max(view.highest, height);
    }
    view.beams.back() = {std::remainder(std::atan2(way.y(), way.x()) - pose.heading, 2.0 * kPi),
                         !is_left_out && range <= options.max_range ? range : kNoReturn};
  }
  return view;
}

/// Unwraps the bearings beyond pi. Returns false unless all ascend or all descend, by less than a full turn in total.
bool unwrap(std::vector<Beam>& beams) {
  Beam* last = nullptr;
  double turn = 0.0;
  int sense = 0;
  for (Beam& beam : beams) {
    if (std::isnan(beam.bearing)) continue;
    if (last != nullptr) {
      const double step = std::remainder(beam.bearing - last->bearing, 2.0 * kPi);
      if (sense == 0) sense = step > 0.0 ? 1 : -1;
      if (step * sense <= 0.0) return false;
      turn += step;
      beam.bearing = last->bearing + step;
    }
    last = &beam;
  }
  return std::abs(turn) < 2.0 * kPi;
}

/// Interpolates unknown bearings between their neighbours. Removes those before the first and after the last known one.
std::vector<Beam> fillIn(const std::vector<Beam>& beams) {
  std::vector<Beam> filled;
  std::size_t unknown = 0;
  for (const Beam& beam : beams) {
    if (std::isnan(beam.bearing)) {
      ++unknown;
      continue;
    }
    if (!filled.empty()) {
      const double from = filled.back().bearing, step = (beam.bearing - from) / static_cast<double>(unknown + 1);
      for (std::size_t i = 1; i <= unknown; ++i) filled.push_back({from + static_cast<double>(i) * step, kNoReturn});
    }
    unknown = 0;
    filled.push_back(beam);
  }
  return filled;
}

/// Returns the beams by ascending bearing. They are sorted only if their own order is not that of a planar laser.
std::vector<Beam> ordered(std::vector<Beam> beams) {
  if (unwrap(beams)) {
    beams = fillIn(beams);
    if (!beams.empty() && beams.front().bearing > beams.back().bearing) std::reverse(beams.begin(), beams.end());
    return beams;
  }
  beams.erase(std::remove_if(beams.begin(), beams.end(), [](const Beam& beam) { return std::isnan(beam.bearing); }),
              beams.end());
  for (Beam& beam : beams) beam.bearing = std::remainder(beam.bearing, 2.0 * kPi);
  std::stable_sort(beams.begin(), beams.end(), [](const Beam& a, const Beam& b) { return a.bearing < b.bearing; });
  return beams;
}

/// Returns the median angle between neighbouring beams [rad], infinity without such an angle.
double usualStep(const std::vector<Beam>& beams) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < beams.size(); ++i)
    if (beams[i].bearing > beams[i - 1].bearing) steps.push_back(beams[i].bearing - beams[i - 1].bearing);
  if (steps.empty()) return std::numeric_limits<double>::infinity();
  return nthSmallest(steps, steps.size() / 2);
}

void addBeam(LaserScan& scan, const Beam& beam) {
  scan.bearings.push_back(beam.bearing);
  scan.ranges.push_back(beam.range);
}

void addSweep(LaserScan& scan, const std::vector<Beam>& beams) {
  const double widest = kGap * usualStep(beams);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (i > 0 && beams[i].bearing - beams[i - 1].bearing > widest)
      addBeam(scan, {(beams[i - 1].bearing + beams[i].bearing) / 2.0, kNoReturn});
    addBeam(scan, beams[i]);
  }
}

/// Adds one beam per step of the full turn: the nearest point in it, or no return.
void addSlice(LaserScan& scan, const std::vector<Beam>& beams, double step_deg) {
  const auto count = static_cast<std::size_t>(std::lround(360.0 / step_deg));
  const double step = 2.0 * kPi / static_cast<double>(count);
  std::vector<Beam> nearest;
  for (std::size_t i = 0; i < count; ++i) nearest.push_back({(static_cast<double>(i) + 0.5) * step - kPi, kNoReturn});
  for (const Beam& beam : beams) {
    if (std::isnan(beam.range)) continue;
    const double place = std::clamp((beam.bearing + kPi) / step, 0.0, static_cast<double>(count - 1));
    Beam& best = nearest[static_cast<std::size_t>(place)];
    if (std::isnan(best.range) || beam.range < best.range) best = beam;
  }
  for (const Beam& beam : nearest) addBeam(scan, beam);
}

}  // namespace

LaserScan planarScan(const Scan& cloud, const PlanarScanOptions& options) {
  checkOptions(options);
  const Eigen::Matrix3d rotation = cloud.pose.rotation.toRotationMatrix();
  LaserScan scan;
  scan.time = cloud.time;
  scan.max_range = std::numeric_limits<double>::infinity();  // farther points have no range already
  scan.pose.translation = cloud.pose.translation.head<2>();
  scan.pose.heading = std::atan2(rotation(1, 0), rotation(0, 0));
  const FromAbove view = lookFromAbove(cloud, scan.pose, options);
  if (options.slice) {
    addSlice(scan, view.beams, options.step);
    return scan;
  }
  if (view.highest - view.lowest > kMaxPlanarHeight)
    throw std::invalid_argument(notPlanarText(view.lowest, view.highest));
  addSweep(scan, ordered(view.beams));
  return scan;
}

std::vector<LaserScan> planarScans(const Scans& scans, const PlanarScanOptions& options) {
  checkOptions(options);
  std::vector<LaserScan> sweeps;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan cloud = scans.read(i);
    try {
      sweeps.push_back(planarScan(cloud, options));
    } catch (const std::invalid_argument& error) {
      throw FileError(scans.info(i).name, error.what());
    }
  }
  return sweeps;
}

}  // namespace gaussmap
