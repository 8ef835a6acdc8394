// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/coordinate_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/quantile.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kMostPoints = 65536;  // of all scans
constexpr double kManyPoints = 0.01;        // share of the points of a scan above which a fault is reported
constexpr std::size_t kFewestPoints = 20;   // fewer points say nothing about their unit
constexpr double kLargestFloat = 1e38;
// A scan in metres does not spread that far from its median in all three directions, and a planar one not that far in
// two. In millimetres, these are 10 cm and 20 cm.
constexpr double kWideSpread = 100.0, kWidePlanarSpread = 200.0;  // [m]

/// Returns the step between floats at the largest coordinate of a point [m].
double stepAt(const Eigen::Vector3d& point) {
  const auto largest = static_cast<float>(std::min(point.cwiseAbs().maxCoeff(), kLargestFloat));
  return double{std::nextafter(largest, std::numeric_limits<float>::infinity())} - double{largest};
}

bool areFloats(const Eigen::Vector3d& point) {
  return point.cwiseAbs().maxCoeff() <= kLargestFloat && point == point.cast<float>().cast<double>();
}

/// Returns the median distance of a coordinate from its median [m].
double spreadAlong(const std::vector<Eigen::Vector3d>& points, int axis) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const Eigen::Vector3d& point : points) values.push_back(point(axis));
  const double median = nthSmallest(values, values.size() / 2);
  for (double& value : values) value = std::abs(value - median);
  return nthSmallest(values, values.size() / 2);
}

bool lookLikeMillimetres(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < kFewestPoints) return false;
  Eigen::Vector3d spread;
  for (int axis = 0; axis < 3; ++axis) spread(axis) = spreadAlong(points, axis);
  std::sort(spread.data(), spread.data() + 3);
  if (spread(0) > kWideSpread) return true;
  if (spread(0) == 0.0 && spread(1) > kWidePlanarSpread) return true;
  return spread(2) > kWideSpread && std::all_of(points.begin(), points.end(), [](const Eigen::Vector3d& point) {
           return point == point.array().round().matrix();
         });
}

std::string andMore(std::size_t scans) {
  return scans > 1 ? " and " + std::to_string(scans - 1) + " more" : "";
}

}  // namespace

CoordinateSamples::CoordinateSamples(std::size_t scans)
    : per_scan_(std::clamp<std::size_t>(kMostPoints / std::max<std::size_t>(scans, 1), 16, 1024)), points_(scans) {}

void CoordinateSamples::add(std::size_t scan, std::size_t first, const PointBlock<3>& block, std::size_t size) {
  const std::size_t every = std::max<std::size_t>(1, size / per_scan_);
  std::size_t next = (first + every - 1) / every * every;
  if (next >= first + block.size) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Eigen::Vector3d>& points = points_[scan];
  if (points.empty())
    points.assign((size + every - 1) / every, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (; next < first + block.size; next += every)
    for (int axis = 0; axis < 3; ++axis) points[next / every](axis) = block.coordinate[axis][next - first];
}

std::vector<Eigen::Vector3d> CoordinateSamples::of(std::size_t scan) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Eigen::Vector3d> finite;
  for (const Eigen::Vector3d& point : points_[scan])
    if (point.allFinite()) finite.push_back(point);
  return finite;
}

std::vector<std::string> warningsOf(const std::vector<SampledScan>& scans, double resolution) {
  std::size_t rounded = 0, millimetres = 0;
  double step = 0.0;
  const SampledScan *first_rounded = nullptr, *first_millimetres = nullptr;
  for (const SampledScan& scan : scans) {
    std::size_t coarse = 0;
    double largest = 0.0;
    for (const Eigen::Vector3d& point : scan.points) {
      if (stepAt(point) <= 0.1 * resolution || !areFloats(point)) continue;
      ++coarse;
      largest = std::max(largest, stepAt(point));
    }
    if (static_cast<double>(coarse) > kManyPoints * static_cast<double>(scan.points.size())) {
      if (rounded++ == 0) first_rounded = &scan;
      step = std::max(step, largest);
    }
    if (lookLikeMillimetres(scan.points) && millimetres++ == 0) first_millimetres = &scan;
  }
  std::vector<std::string> warnings;
  std::ostringstream text;
  if (first_rounded != nullptr) {
    text << first_rounded->path.string() << andMore(rounded) << ": the coordinates are rounded to steps of " << step
         << " m, because they are 32-bit floats far from the origin; the side of a cell is " << resolution << " m. "
         << (first_rounded->is_ascii ? "Change SIZE of x y z to 8 in the header if the text has more digits"
                                     : "Write the points again from their source, as doubles (in PCD files: SIZE 8) or "
                                       "relative to a pose near them");
    warnings.push_back(text.str());
  }
  if (first_millimetres != nullptr) {
    text.str("");
    Eigen::Vector3d low = first_millimetres->points.front(), high = low;
    for (const Eigen::Vector3d& point : first_millimetres->points) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
    text.precision(3);
    text << first_millimetres->path.string() << andMore(millimetres) << ": the points spread over "
         << high.x() - low.x() << " x " << high.y() - low.y() << " x " << high.z() - low.z()
         << " m. Are the coordinates millimetres? Gaussmap expects metres: multiply x y z by 0.001. For PCD files, use "
            "pcl_transform_point_cloud IN.pcd OUT.pcd -scale 0.001,0.001,0.001; for text files and raw records, use "
            "--fields \"x:mm y:mm z:mm\"";
    warnings.push_back(text.str());
  }
  return warnings;
}

}  // namespace gaussmap::detail
