// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/sensor/visibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sensor/default_lengths.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kDeviations = 3.0;  // of the noise

/// Returns the number of pixels from one tested pixel to the next. The pixels of a camera are narrower than those of a
/// lidar: without `spacing` [m, at the point], a pose error of 2 cm would show free space where the edge of a thing is.
int stepAt(const Projection& projection, const Eigen::Vector3d& point, double spacing) {
  const auto* const camera = std::get_if<PlanarProjection>(&projection);
  if (!camera) return 1;
  const double step = std::ceil(std::max(camera->fx, camera->fy) * spacing / point.z());
  return static_cast<int>(std::clamp(step, 1.0, std::max(1.0, 0.25 * std::min(camera->rows, camera->columns))));
}

/// Returns the distance by which the noise widens the limits [m]: of a point and of the end of a beam behind it, both
/// given by their ranges.
double noiseMargin(const Projection& projection, const VisibilityOptions& options, const Eigen::Vector3d& point,
                   double range, double end) {
  const bool is_camera = std::holds_alternative<PlanarProjection>(projection);
  if (!options.noise && !is_camera) return 0.0;
  const DepthNoise noise = options.noise.value_or(DepthNoise::camera());
  const double depth_per_range = is_camera ? point.z() / range : 1.0;
  return kDeviations * (noise.at(depth_per_range * range) + noise.at(depth_per_range * end)) / depth_per_range;
}

/// Returns the distance of a point from the surface through the ends a and b of two beams [m]. The surface is
/// perpendicular to the plane of the two beams.
double distanceToSurface(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d normal = (b - a).cross(a.cross(b));
  const double length = normal.norm();
  return length > 0.0 ? std::abs(normal.dot(point - a)) / length : (point - a).norm();
}

/// Returns the minimum distance of a point from the surfaces between two pixels around it [m]. The two pixels lie one
/// above the other; in an image of one row, side by side.
double distanceToBeams(const RangeImage& image, const Eigen::Vector3d& point, Pixel pixel, int step) {
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](int row_a, int column_a, int row_b, int column_b) {
    if (image.around(row_a, column_a).empty() || image.around(row_b, column_b).empty()) return;
    least = std::min(
        least, distanceToSurface(point, image.nearestPoint(row_a, column_a), image.nearestPoint(row_b, column_b)));
  };
  if (image.rows() == 1) {
    consider(0, pixel.column - step, 0, pixel.column);
    consider(0, pixel.column, 0, pixel.column + step);
  } else {
    for (int column = pixel.column - step; column <= pixel.column + step; column += step) {
      consider(pixel.row - step, column, pixel.row, column);
      consider(pixel.row, column, pixel.row + step, column);
    }
  }
  return least;
}

}  // namespace

Visibility visibilityOf(const RangeImage& image, const Eigen::Vector3d& point, const VisibilityOptions& options) {
  const std::optional<Pixel> pixel = pixelOf(image.projection(), point);
  if (!pixel) return Visibility::OutOfView;
  const int step = stepAt(image.projection(), point, spacingOf(options)), reach = image.rows() > 1 ? step : 0;
  int seen = 0;
  float nearest = std::numeric_limits<float>::infinity();
  for (int row = pixel->row - reach; row <= pixel->row + reach; row += step)
    for (int column = pixel->column - step; column <= pixel->column + step; column += step) {
      const PixelRanges ranges = image.around(row, column);
      if (ranges.empty()) continue;
      ++seen;
      nearest = std::min(nearest, ranges.nearest);
    }
  if (2 * seen < (image.rows() > 1 ? 9 : 3)) return Visibility::NoEvidence;
  const double range = point.norm(), tolerance = toleranceOf(options);
  if (nearest < range - tolerance) return Visibility::Hidden;
  if (nearest <= range + tolerance) return Visibility::AtSurface;
  const double margin = noiseMargin(image.projection(), options, point, range, double(nearest));
  if (nearest <= range + tolerance + margin) return Visibility::AtSurface;
  const bool is_near = distanceToBeams(image, point, *pixel, step) < clearanceOf(options) + margin;
  return is_near ? Visibility::AtSurface : Visibility::PassedThrough;
}

}  // namespace gaussmap
