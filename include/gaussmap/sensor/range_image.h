// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "gaussmap/sensor/projection.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What the beams of one pixel measured, ranges from the sensor [m]. Empty (no beam came back): nearest is infinite.
struct GAUSSMAP_API PixelRanges {
  float nearest = std::numeric_limits<float>::infinity();
  float farthest = 0.0f;
  bool empty() const { return nearest > farthest; }
};

/// One scan as its sensor saw it: per pixel the smallest and the largest range. That a pixel is empty says nothing
/// about the space in it (black, wet and far things give no return either).
class GAUSSMAP_API RangeImage {
 public:
  /// An image without any return. Throws std::invalid_argument if the projection is not usable.
  explicit RangeImage(Projection projection);
  /// The image of a scan [m, sensor frame]. Points outside the field of view, or that are no returns, are left out.
  RangeImage(Projection projection, const std::vector<Eigen::Vector3d>& points);

  const Projection& projection() const { return projection_; }
  int rows() const { return rows_; }
  int columns() const { return columns_; }

  /// Enters one return.
  void add(const Eigen::Vector3d& point);
  /// Takes every empty pixel for free space up to `range` [m] (for sensors that miss nothing up to there).
  /// Throws std::invalid_argument unless it is positive and fits a float.
  void noReturnIsFree(double range);

  /// row in [0, rows), column in [0, columns).
  const PixelRanges& at(int row, int column) const { return pixels_[index(row, column)]; }
  /// For any row and column: outside of the image (columns wrap round if they do in the projection) all is empty.
  PixelRanges around(int row, int column) const;
  /// The point at the nearest range in the middle of a pixel that is not empty [m, sensor frame]; row and column as for
  /// around().
  Eigen::Vector3d nearestPoint(int row, int column) const;
  /// The largest range of all [m], 0 if there is none.
  float farthest() const { return farthest_; }
  /// Points entered, and the pixels that hold them.
  std::size_t returns() const { return returns_; }
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
