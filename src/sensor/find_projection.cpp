// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/quantile.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/sensor/projection.h"
#include "sensor/angles.h"

namespace gaussmap {
using namespace detail;

namespace {

struct Ray {
  double azimuth;
  double elevation;
};

/// Number of azimuth sectors, about 4 degrees wide. sectorOf() finds the sector of a point without an arc tangent.
constexpr int kSectors = 96;
int sectorOf(const Eigen::Vector3d& point) {
  const double width = std::abs(point.x()) + std::abs(point.y());
  if (!(width > 0.0)) return 0;
  const double along = 1.0 - point.x() / width;  // 0 ... 2 from x to -x, on either side
  const double turn = point.y() < 0.0 ? 4.0 - along : along;
  return std::min(static_cast<int>(0.25 * turn * kSectors), kSectors - 1);
}

/// The directions of the beams of a scan.
struct Beams {
  std::vector<double> elevations;  // of all beams [rad]
  std::vector<Ray> rays;           // of a large scan only some sectors: the spacing is the same all around
};

Beams beamsOf(const std::vector<Eigen::Vector3d>& points) {
  constexpr std::size_t kEnough = 16000;
  constexpr int kStride = 37;  // coprime to kSectors: reaches all sectors, and neighbouring ones late
  Beams beams;
  std::vector<const Eigen::Vector3d*> returns;
  std::vector<std::size_t> sizes(kSectors);
  std::vector<std::uint8_t> sectors;
  for (const Eigen::Vector3d& point : points) {
    if (!isReturn(point)) continue;
    beams.elevations.push_back(elevationOf(point));
    returns.push_back(&point);
    sectors.push_back(static_cast<std::uint8_t>(sectorOf(point)));
    ++sizes[sectors.back()];
  }
  std::vector<bool> taken(kSectors);
  std::size_t count = 0;
  for (int turn = 0; turn < kSectors && count < kEnough; ++turn) {
    const auto sector = static_cast<std::size_t>(turn * kStride % kSectors);
    taken[sector] = true;
    count += sizes[sector];
  }
  beams.rays.reserve(count);
  for (std::size_t i = 0; i < returns.size(); ++i)
    if (taken[sectors[i]]) beams.rays.push_back({azimuthOf(*returns[i]), beams.elevations[i]});
  return beams;
}

/// Returns a quantile of values in any order; 0 if there are none.
double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  return nthSmallest(values, static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

/// Returns the differences in elevation between points one above the other, in the same slice of azimuth [rad]. Beams
/// of one ring differ by less than `kSameRing`, and are left out.
std::vector<double> verticalSteps(const std::vector<Ray>& rays) {
  constexpr double kSlice = 0.25 * kDegree, kSameRing = 0.05 * kDegree;
  std::vector<std::pair<int, double>> slices;
  slices.reserve(rays.size());
  for (const Ray& ray : rays) slices.emplace_back(static_cast<int>(std::floor(ray.azimuth / kSlice)), ray.elevation);
  std::sort(slices.begin(), slices.end());
  std::vector<double> steps;
  for (std::size_t i = 1; i < slices.size(); ++i)
    if (slices[i].first == slices[i - 1].first && slices[i].second - slices[i - 1].second > kSameRing)
      steps.push_back(slices[i].second - slices[i - 1].second);
  return steps;
}

/// A smoothed histogram of elevations, and its peaks.
class Elevations {
 public:
  Elevations(const std::vector<double>& elevations, double low, double high, double bin) : low_(low), bin_(bin) {
    std::vector<double> counts(static_cast<std::size_t>((high - low) / bin) + 1);
    for (const double elevation : elevations) counts[static_cast<std::size_t>((elevation - low) / bin)] += 1.0;
    const auto n = static_cast<int>(counts.size());
    for (int i = 0; i < n; ++i) {
      double sum = 0.0;
      for (int k = std::max(0, i - kReach); k <= std::min(n - 1, i + kReach); ++k)
        sum += counts[static_cast<std::size_t>(k)] * std::exp(-0.125 * (i - k) * (i - k));
      density_.push_back(sum);
    }
    for (int i = 0; i < n; ++i)
      if (isPeak(i)) peaks_.push_back(static_cast<std::size_t>(i));
  }

  /// Returns the density in the median gap between two peaks, as a share of the lower peak. It is about 0 if the
  /// elevations form rings, and 1 if there is no gap.
  double gapDensity() const {
    std::vector<double> gaps;
    for (std::size_t i = 1; i < peaks_.size(); ++i) {
      const auto begin = density_.begin();
      const double least = *std::min_element(begin + static_cast<std::ptrdiff_t>(peaks_[i - 1]),
                                             begin + static_cast<std::ptrdiff_t>(peaks_[i]));
      gaps.push_back(least / std::min(density_[peaks_[i - 1]], density_[peaks_[i]]));
    }
    return gaps.empty() ? 1.0 : quantile(gaps, 0.5);
  }

  std::vector<double> peaks() const {
    std::vector<double> elevations;
    for (const std::size_t peak : peaks_) elevations.push_back(low_ + (static_cast<double>(peak) + 0.5) * bin_);
    return elevations;
  }

 private:
  static constexpr int kReach = 4;

  bool isPeak(int i) const {
    const double here = density_[static_cast<std::size_t>(i)];
    const int n = static_cast<int>(density_.size());
    for (int k = std::max(0, i - kReach); k <= std::min(n - 1, i + kReach); ++k) {
      const double there = density_[static_cast<std::size_t>(k)];
      if (there > here || (there == here && k < i)) return false;
    }
    return here > 0.0;
  }

  double low_, bin_;
  std::vector<double> density_;
  std::vector<std::size_t> peaks_;
};

std::vector<double> bordersBetween(const std::vector<double>& rings) {
  std::vector<double> borders = {rings[0] - 0.5 * (rings[1] - rings[0])};
  for (std::size_t i = 1; i < rings.size(); ++i) borders.push_back(0.5 * (rings[i - 1] + rings[i]));
  borders.push_back(rings.back() + 0.5 * (rings.back() - rings[rings.size() - 2]));
  return borders;
}

/// Returns the median difference in azimuth between neighbours of the same ring [rad].
double azimuthStep(const std::vector<Ray>& rays, const std::vector<double>& rings) {
  constexpr double kSameBeam = 1e-5;
  std::vector<std::pair<std::size_t, double>> sorted;
  sorted.reserve(rays.size());
  for (const Ray& ray : rays) {
    const auto above = std::lower_bound(rings.begin(), rings.end(), ray.elevation);
    const bool lower =
        above == rings.end() || (above != rings.begin() && ray.elevation - above[-1] < *above - ray.elevation);
    sorted.emplace_back(static_cast<std::size_t>(above - rings.begin()) - (lower ? 1 : 0), ray.azimuth);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first && sorted[i].second - sorted[i - 1].second > kSameBeam)
      steps.push_back(sorted[i].second - sorted[i - 1].second);
  return quantile(std::move(steps), 0.5);
}

int columnsFor(double step) {
  // Measured: 1 to 3 find the same moving points, but values below 2 find more static ones too.
  constexpr double kStepsPerColumn = 2.0;
  constexpr double kMaxColumns = 36000.0;
  if (!(step > 0.0)) return 360;
  return static_cast<int>(std::lround(std::clamp(2.0 * kPi / (kStepsPerColumn * step), 4.0, kMaxColumns)));
}

}  // namespace

std::optional<SphericalProjection> findSphericalProjection(const std::vector<Eigen::Vector3d>& points) {
  const Beams beams = beamsOf(points);
  if (beams.elevations.size() < 3) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(beams.elevations.begin(), beams.elevations.end());
  const double low = *lowest, high = *highest;

  const std::vector<double> vertical = verticalSteps(beams.rays);
  const double usual = quantile(vertical, 0.5);
  if (vertical.empty()) {  // all beams in one plane
    const double step = azimuthStep(beams.rays, {0.5 * (low + high)});
    const double half = std::max(0.5 * (high - low), 0.5 * (step > 0.0 ? step : kDegree)) + 1e-6;
    return SphericalProjection{{0.5 * (low + high) - half, 0.5 * (low + high) + half}, columnsFor(step)};
  }
  const Elevations elevations(beams.elevations, low, high, usual / 16.0);
  const std::vector<double> rings = elevations.peaks();
  const double step = azimuthStep(beams.rays, rings);
  if (rings.size() > 1 && elevations.gapDensity() < 0.5)
    return SphericalProjection{bordersBetween(rings), columnsFor(step)};

  const double height = std::max(quantile(vertical, 0.9), step);
  SphericalProjection projection{{low}, columnsFor(step)};
  while (projection.row_borders.back() <= high)
    projection.row_borders.push_back(projection.row_borders.back() + height);
  return projection;
}

std::optional<PlanarProjection> findPlanarProjection(const std::vector<Eigen::Vector3d>& points, int columns) {
  if (columns < 2 || points.size() % static_cast<std::size_t>(columns) != 0) return std::nullopt;
  const int rows = static_cast<int>(points.size() / static_cast<std::size_t>(columns));
  // Fits two straight lines: column = fx x / z + cx and row = fy y / z + cy.
  struct Line {
    double n = 0.0, s = 0.0, ss = 0.0, t = 0.0, st = 0.0;
    void add(double slope, double target) {
      n += 1.0;
      s += slope;
      ss += slope * slope;
      t += target;
      st += slope * target;
    }
    double focal() const { return (n * st - s * t) / (n * ss - s * s); }
    double middle() const { return (t - focal() * s) / n; }
  } across, down;
  const auto forEach = [&](const auto& body) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].allFinite() || !(points[i].z() > 0.0)) continue;
      const std::size_t row = i / static_cast<std::size_t>(columns), column = i % static_cast<std::size_t>(columns);
      body(points[i].x() / points[i].z(), static_cast<double>(column), points[i].y() / points[i].z(),
           static_cast<double>(row));
    }
  };
  forEach([&](double x, double column, double y, double row) {
    across.add(x, column);
    down.add(y, row);
  });
  const PlanarProjection found{across.focal(), down.focal(), across.middle(), down.middle(), columns, rows};
  if (across.n < 4.0 || !(found.fx > 0.0) || !(found.fy > 0.0) || !std::isfinite(found.fx + found.fy)) return {};
  double error = 0.0;
  forEach([&](double x, double column, double y, double row) {
    error += std::pow(found.fx * x + found.cx - column, 2) + std::pow(found.fy * y + found.cy - row, 2);
  });
  if (!(error / across.n < 1.0)) return std::nullopt;
  return found;
}

std::optional<Projection> findProjection(const std::vector<Eigen::Vector3d>& points, int columns) {
  if (columns > 0 && static_cast<std::size_t>(columns) < points.size())
    if (const auto camera = findPlanarProjection(points, columns)) return *camera;
  if (auto lidar = findSphericalProjection(points)) return *std::move(lidar);
  return std::nullopt;
}

}  // namespace gaussmap
