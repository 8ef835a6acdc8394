// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "gaussmap/sensor/projection.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The smallest and the largest range that the beams of one pixel measured. A range is a distance from the sensor. If
/// no beam of the pixel returned, the pixel is empty and `nearest` is infinite.
struct GAUSSMAP_API PixelRanges {
  float nearest = std::numeric_limits<float>::infinity();  ///< smallest range [m]
  float farthest = 0.0f;                                   ///< largest range [m]
  /// Returns true if the pixel has no range.
  bool empty() const { return nearest > farthest; }
};

/// One scan as a range image: the smallest and the largest range per pixel. An empty pixel does not mean free space,
/// because black, wet and distant surfaces also give no return.
class GAUSSMAP_API RangeImage {
 public:
  /// Makes an image without returns. Throws std::invalid_argument if the projection is not usable.
  explicit RangeImage(Projection projection);
  /// Makes the image of a scan [m, sensor frame]. Points outside the field of view and points that are not returns are
  /// ignored. Throws std::invalid_argument if the projection is not usable.
  RangeImage(Projection projection, const std::vector<Eigen::Vector3d>& points);

  /// Returns the projection.
  const Projection& projection() const { return projection_; }
  /// Returns the number of rows.
  int rows() const { return rows_; }
  /// Returns the number of columns.
  int columns() const { return columns_; }

  /// Adds one point [m, sensor frame], if it is a return in the field of view.
  void add(const Eigen::Vector3d& point);
  /// Gives every empty pixel the range `range` [m], so that the space up to it counts as free. Use it only for sensors
  /// that see every object up to this range. Throws std::invalid_argument unless the range is positive and finite as a
  /// float.
  void noReturnIsFree(double range);

  /// Returns the ranges of a pixel, with row in [0, rows) and column in [0, columns).
  const PixelRanges& at(int row, int column) const { return pixels_[index(row, column)]; }
  /// Returns the ranges of a pixel with any row and column. Outside the image the pixel is empty. Columns wrap around
  /// if the projection does (see wraps()).
  PixelRanges around(int row, int column) const;
  /// Returns the point in the direction of the pixel's centre, at the smallest range of the pixel [m, sensor frame].
  /// The pixel must not be empty. Row and column are as for around().
  Eigen::Vector3d nearestPoint(int row, int column) const;
  /// Returns the largest range in the image [m], including that of noReturnIsFree(), or 0 if all pixels are empty.
  float farthest() const { return farthest_; }
  /// Returns the number of points in the image.
  std::size_t returns() const { return returns_; }
  /// Returns the number of pixels with points.
  std::size_t filledPixels() const { return filled_; }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  Projection projection_;
  int rows_, columns_;
  bool wraps_;
  float farthest_ = 0.0f;
  std::size_t returns_ = 0, filled_ = 0;
  std::vector<PixelRanges> pixels_;  // by rows
};

}  // namespace gaussmap
