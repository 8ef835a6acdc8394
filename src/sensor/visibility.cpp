// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/sensor/visibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace gaussmap {
namespace {

/// Returns the distance of a point from the surface through the ends a and b of two beams [m]. The surface is
/// perpendicular to the plane of the two beams.
double distanceToSurface(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d normal = (b - a).cross(a.cross(b));
  const double length = normal.norm();
  return length > 0.0 ? std::abs(normal.dot(point - a)) / length : (point - a).norm();
}

/// Returns the minimum distance of a point from the surfaces between two pixels around it [m]. The two pixels lie one
/// above the other; in an image of one row, side by side.
double clearanceOf(const RangeImage& image, const Eigen::Vector3d& point, Pixel pixel) {
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](int row_a, int column_a, int row_b, int column_b) {
    if (image.around(row_a, column_a).empty() || image.around(row_b, column_b).empty()) return;
    least = std::min(
        least, distanceToSurface(point, image.nearestPoint(row_a, column_a), image.nearestPoint(row_b, column_b)));
  };
  if (image.rows() == 1) {
    consider(0, pixel.column - 1, 0, pixel.column);
    consider(0, pixel.column, 0, pixel.column + 1);
  } else {
    for (int column = pixel.column - 1; column <= pixel.column + 1; ++column) {
      consider(pixel.row - 1, column, pixel.row, column);
      consider(pixel.row, column, pixel.row + 1, column);
    }
  }
  return least;
}

}  // namespace

Visibility visibilityOf(const RangeImage& image, const Eigen::Vector3d& point, const VisibilityOptions& options) {
  const std::optional<Pixel> pixel = pixelOf(image.projection(), point);
  if (!pixel) return Visibility::OutOfView;
  const int reach = image.rows() > 1 ? 1 : 0;
  int seen = 0;
  float nearest = std::numeric_limits<float>::infinity();
  for (int row = pixel->row - reach; row <= pixel->row + reach; ++row)
    for (int column = pixel->column - 1; column <= pixel->column + 1; ++column) {
      const PixelRanges ranges = image.around(row, column);
      if (ranges.empty()) continue;
      ++seen;
      nearest = std::min(nearest, ranges.nearest);
    }
  if (2 * seen < 3 * (2 * reach + 1)) return Visibility::NoEvidence;
  const double range = point.norm();
  if (nearest < range - options.tolerance) return Visibility::Hidden;
  if (nearest <= range + options.tolerance) return Visibility::AtSurface;
  return clearanceOf(image, point, *pixel) < options.clearance ? Visibility::AtSurface : Visibility::PassedThrough;
}

}  // namespace gaussmap
