// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/sensor_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sensor/angles.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kScans = 8;           // scans that are compared, evenly chosen
constexpr std::size_t kPerDirection = 16;   // points per bin of directions, on average
constexpr int kMostColumns = 48;            // bins of directions along the horizon
constexpr std::size_t kMaxPoints = 200000;  // of a scan; more do not change the result
constexpr double kSameRange = 0.65;         // measured for a sensor that stands still: 0.88 to 1, also in traffic
constexpr double kRangeRatio = 0.05, kRangeOffset = 0.05;  // ranges that differ by less are the same [1], [m]

/// Returns the least ratio of the numbers of points of two scans of one place, with `mean` points per direction. A
/// random choice of points has a larger ratio: 0.79 with 16 points, 0.9 with 100.
double leastDensity(double mean) {
  return 0.85 - 0.6 / std::sqrt(std::max(mean, double(kPerDirection)));
}

/// The ranges of one scan, sorted into bins of directions of equal area.
struct View {
  std::size_t scan = 0;
  double share = 1.0;                      // of the points of the scan that was used
  std::vector<std::vector<float>> ranges;  // per bin, ascending
};

/// Returns true if the median of `a` is a usual range of `b`: between its quartiles, or close to them.
bool isUsual(const std::vector<float>& a, const std::vector<float>& b) {
  const double median = double(a[a.size() / 2]), margin = kRangeOffset + kRangeRatio * median;
  return median >= double(b[b.size() / 4]) - margin && median <= double(b[(3 * b.size()) / 4]) + margin;
}

View viewOf(const Scan& scan, std::size_t index, int columns) {
  const int rows = columns / 2;
  View view{index, 1.0, {}};
  view.ranges.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  const std::size_t stride = scan.points.size() / kMaxPoints + 1;
  view.share = 1.0 / static_cast<double>(stride);
  const Eigen::Matrix3d rotation = scan.pose.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < scan.points.size(); i += stride) {
    if (!isReturn(scan.points[i])) continue;
    const Eigen::Vector3d point = rotation * scan.points[i];
    const double range = point.norm();
    if (!std::isfinite(range)) continue;
    const int column = static_cast<int>((azimuthOf(point) + kPi) / (2.0 * kPi) * columns);
    const int row = static_cast<int>(0.5 * (point.z() / range + 1.0) * rows);
    view.ranges[static_cast<std::size_t>(std::min(row, rows - 1)) * static_cast<std::size_t>(columns) +
                static_cast<std::size_t>(std::min(column, columns - 1))]
        .push_back(static_cast<float>(range));
  }
  for (std::vector<float>& bin : view.ranges) std::sort(bin.begin(), bin.end());
  return view;
}

std::optional<SameView> compare(const View& a, const View& b) {
  double fewer = 0.0, more = 0.0, points = 0.0, same = 0.0, used = 0.0, bins = 0.0;
  for (std::size_t bin = 0; bin < a.ranges.size(); ++bin) {
    const std::vector<float>&left = a.ranges[bin], &right = b.ranges[bin];
    if (left.empty() || right.empty() || left.size() + right.size() < kPerDirection) continue;
    const double m = double(left.size()) / a.share, n = double(right.size()) / b.share;
    fewer += std::min(m, n);
    more += std::max(m, n);
    points += m + n;
    used += 0.5 * double(left.size() + right.size());
    bins += 1.0;
    if (isUsual(left, right) && isUsual(right, left)) same += m + n;
  }
  if (!(points > 0.0)) return std::nullopt;
  return SameView{a.scan, b.scan, fewer / more, same / points, leastDensity(used / bins)};
}

/// Returns true if there are at least two scans, all with the same sensor position.
bool allAtOnePosition(const Scans& scans) {
  if (scans.size() < 2) return false;
  const Eigen::Vector3d position = scans.info(0).pose.translation;
  for (std::size_t i = 1; i < scans.size(); ++i)
    if (scans.info(i).pose.translation != position) return false;
  return true;
}

}  // namespace

bool SameView::moved() const {
  return density < least_density || range < kSameRange;
}

std::optional<SameView> compareViews(const Scans& scans) {
  if (!allAtOnePosition(scans)) return std::nullopt;
  const std::size_t count = std::min(kScans, scans.size());
  std::vector<View> views;
  int columns = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = i * (scans.size() - 1) / (count - 1);
    const Scan scan = scans.read(index);
    const auto returns = static_cast<std::size_t>(std::count_if(scan.points.begin(), scan.points.end(), isReturn));
    if (returns == 0) continue;
    if (columns == 0) {
      const double bins = double(returns) / double(kPerDirection);
      columns = std::clamp(static_cast<int>(std::sqrt(2.0 * bins)) & ~1, 8, kMostColumns);
    }
    views.push_back(viewOf(scan, index, columns));
  }
  std::vector<SameView> pairs;
  for (std::size_t a = 0; a < views.size(); ++a)
    for (std::size_t b = a + 1; b < views.size(); ++b)
      if (const auto pair = compare(views[a], views[b])) pairs.push_back(*pair);
  if (pairs.empty()) return std::nullopt;
  std::sort(pairs.begin(), pairs.end(), [](const SameView& a, const SameView& b) {
    return std::min(a.density - a.least_density, a.range - kSameRange) <
           std::min(b.density - b.least_density, b.range - kSameRange);
  });
  const std::size_t ignored = views.size() < 4 ? 0 : views.size() - 1;  // the pairs of one scan
  return pairs[std::min(ignored, pairs.size() - 1)];
}

}  // namespace gaussmap::detail
