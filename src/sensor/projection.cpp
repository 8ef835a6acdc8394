// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/sensor/projection.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "gaussmap/core/scans.h"
#include "sensor/angles.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kRounding = 1e-7;  // upper bound of the error of an arc sine near 1, by rounding of its argument [rad]
constexpr double kMaxPixels = 268435456.0;  // 2 GB of ranges

int rowOf(const SphericalProjection& projection, double elevation) {
  const auto& borders = projection.row_borders;
  return static_cast<int>(std::upper_bound(borders.begin(), borders.end(), elevation) - borders.begin()) - 1;
}

/// Returns the column without wrapping: from -columns / 2 to columns * 3 / 2 for azimuths from -2 pi to 2 pi.
int columnOf(const SphericalProjection& projection, double azimuth) {
  return static_cast<int>(std::floor((azimuth + kPi) / (2.0 * kPi) * projection.columns));
}

std::optional<Pixel> pixelIn(const SphericalProjection& projection, const Eigen::Vector3d& point) {
  const double elevation = elevationOf(point);
  const int row = rowOf(projection, elevation);
  if (row < 0 || row >= static_cast<int>(projection.row_borders.size()) - 1) return std::nullopt;
  const int column = columnOf(projection, azimuthOf(point));
  return Pixel{row, std::min(column, projection.columns - 1)};
}

std::optional<Pixel> pixelIn(const PlanarProjection& projection, const Eigen::Vector3d& point) {
  if (!(point.z() > 0.0)) return std::nullopt;
  const double column = std::floor(projection.fx * point.x() / point.z() + projection.cx + 0.5);
  const double row = std::floor(projection.fy * point.y() / point.z() + projection.cy + 0.5);
  if (!(column >= 0.0 && column < projection.columns && row >= 0.0 && row < projection.rows)) return std::nullopt;
  return Pixel{static_cast<int>(row), static_cast<int>(column)};
}

Eigen::Vector3d directionIn(const SphericalProjection& projection, Pixel pixel) {
  const auto row = static_cast<std::size_t>(pixel.row);
  const double elevation = 0.5 * (projection.row_borders[row] + projection.row_borders[row + 1]);
  const double azimuth = (pixel.column + 0.5) / projection.columns * 2.0 * kPi - kPi;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

Eigen::Vector3d directionIn(const PlanarProjection& projection, Pixel pixel) {
  return Eigen::Vector3d((pixel.column - projection.cx) / projection.fx, (pixel.row - projection.cy) / projection.fy,
                         1.0)
      .normalized();
}

PixelBox pixelsIn(const SphericalProjection& projection, const Eigen::Vector3d& centre, double radius) {
  const int rows = static_cast<int>(projection.row_borders.size()) - 1;
  PixelBox box{0, rows - 1, 0, projection.columns - 1};
  const double range = centre.norm();
  if (!(range > radius)) return box;
  const double elevation = elevationOf(centre), width = std::asin(radius / range) + kRounding;
  box.first_row = std::max(0, rowOf(projection, elevation - width));
  box.last_row = std::min(rows - 1, rowOf(projection, elevation + width));
  if (std::abs(elevation) + width >= kPi / 2.0) return box;  // the ball covers a pole: any azimuth
  const double azimuth = azimuthOf(centre);
  const double half = std::asin(std::min(1.0, std::sin(width) / std::cos(elevation))) + kRounding;
  box.first_column = columnOf(projection, azimuth - half);
  box.last_column = columnOf(projection, azimuth + half);
  if (box.last_column - box.first_column >= projection.columns - 1) {
    box.first_column = 0;
    box.last_column = projection.columns - 1;
  }
  return box;
}

/// Finds the range of side / forward in which a ball is seen. In the plane (side, forward) the ball is a circle, and
/// the range lies between its tangents through the pinhole. Returns false if the ball may reach behind the camera's
/// plane: then nothing can be excluded.
bool slopes(double side, double forward, double radius, double& low, double& high) {
  const double square = side * side + forward * forward - radius * radius;
  if (forward <= radius || square <= 0.0) return false;
  const double angle = std::atan2(side, forward), width = std::asin(radius / std::hypot(side, forward)) + kRounding;
  if (std::abs(angle) + width >= kPi / 2.0) return false;
  low = std::tan(angle - width);
  high = std::tan(angle + width);
  return true;
}

PixelBox pixelsIn(const PlanarProjection& projection, const Eigen::Vector3d& centre, double radius) {
  PixelBox box{0, projection.rows - 1, 0, projection.columns - 1};
  if (centre.z() + radius <= 0.0) return {};
  const auto clip = [](double low, double high, double focal, double middle, int& first, int& last) {
    first = static_cast<int>(std::clamp(std::floor(focal * low + middle + 0.5), double(first), last + 1.0));
    last = static_cast<int>(std::clamp(std::floor(focal * high + middle + 0.5), first - 1.0, double(last)));
  };
  double low = 0.0, high = 0.0;
  if (slopes(centre.x(), centre.z(), radius, low, high))
    clip(low, high, projection.fx, projection.cx, box.first_column, box.last_column);
  if (slopes(centre.y(), centre.z(), radius, low, high))
    clip(low, high, projection.fy, projection.cy, box.first_row, box.last_row);
  return box;
}

void checkSize(int rows, int columns) {
  require(rows >= 1, "rows", rows, "must be at least 1");
  require(columns >= 1, "columns", columns, "must be at least 1");
  if (static_cast<double>(rows) * columns > kMaxPixels)
    throw std::invalid_argument("an image of " + std::to_string(rows) + " x " + std::to_string(columns) +
                                " pixels is too large: at most 2^28");
}

void check(const SphericalProjection& projection) {
  const auto& borders = projection.row_borders;
  if (borders.size() < 2) throw std::invalid_argument("a spherical projection needs at least 2 row borders");
  for (std::size_t i = 0; i < borders.size(); ++i)
    require(std::isfinite(borders[i]) && (i == 0 || borders[i] > borders[i - 1]), "row border " + std::to_string(i),
            borders[i], "must be finite and above the border before it");
  checkSize(static_cast<int>(borders.size()) - 1, projection.columns);
}

void check(const PlanarProjection& projection) {
  const auto checkFocal = [](const char* name, double focal) {
    require(focal > 0.0 && std::isfinite(focal), name, focal, "must be positive and finite");
  };
  checkFocal("fx", projection.fx);
  checkFocal("fy", projection.fy);
  require(std::isfinite(projection.cx), "cx", projection.cx, "must be finite");
  require(std::isfinite(projection.cy), "cy", projection.cy, "must be finite");
  checkSize(projection.rows, projection.columns);
}

}  // namespace

int rowsOf(const Projection& projection) {
  if (const auto* spherical = std::get_if<SphericalProjection>(&projection))
    return static_cast<int>(spherical->row_borders.size()) - 1;
  return std::get<PlanarProjection>(projection).rows;
}

int columnsOf(const Projection& projection) {
  return std::visit([](const auto& one) { return one.columns; }, projection);
}

bool wraps(const Projection& projection) {
  return std::holds_alternative<SphericalProjection>(projection);
}

std::optional<Pixel> pixelOf(const Projection& projection, const Eigen::Vector3d& point) {
  if (!isReturn(point)) return std::nullopt;
  return std::visit([&](const auto& one) { return pixelIn(one, point); }, projection);
}

Eigen::Vector3d directionOf(const Projection& projection, Pixel pixel) {
  return std::visit([&](const auto& one) { return directionIn(one, pixel); }, projection);
}

PixelBox pixelsOf(const Projection& projection, const Eigen::Vector3d& centre, double radius) {
  return std::visit([&](const auto& one) { return pixelsIn(one, centre, radius); }, projection);
}

void checkProjection(const Projection& projection) {
  std::visit([](const auto& one) { check(one); }, projection);
}

}  // namespace gaussmap
