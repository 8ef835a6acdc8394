// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/sensor/range_image.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/check.h"

namespace gaussmap {
using namespace detail;

RangeImage::RangeImage(Projection projection) : projection_(std::move(projection)) {
  checkProjection(projection_);
  rows_ = rowsOf(projection_);
  columns_ = columnsOf(projection_);
  wraps_ = wraps(projection_);
  pixels_.resize(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
}

RangeImage::RangeImage(Projection projection, const std::vector<Eigen::Vector3d>& points)
    : RangeImage(std::move(projection)) {
  for (const Eigen::Vector3d& point : points) add(point);
}

void RangeImage::add(const Eigen::Vector3d& point) {
  const std::optional<Pixel> pixel = pixelOf(projection_, point);
  if (!pixel) return;
  const auto range = static_cast<float>(point.norm());
  if (!std::isfinite(range)) return;  // an infinite range would declare everything before it free
  PixelRanges& ranges = pixels_[index(pixel->row, pixel->column)];
  ++returns_;
  filled_ += ranges.empty();
  ranges.nearest = std::min(ranges.nearest, range);
  ranges.farthest = std::max(ranges.farthest, range);
  farthest_ = std::max(farthest_, range);
}

void RangeImage::noReturnIsFree(double range) {
  const auto limit = static_cast<float>(range);
  require(limit > 0.0f && std::isfinite(limit), "range of noReturnIsFree()", range, "must be positive and finite");
  for (PixelRanges& pixel : pixels_)
    if (pixel.empty()) pixel = {limit, limit};
  farthest_ = std::max(farthest_, limit);
}

PixelRanges RangeImage::around(int row, int column) const {
  if (row < 0 || row >= rows_) return {};
  if (column < 0 || column >= columns_) {
    if (!wraps_) return {};
    column = ((column % columns_) + columns_) % columns_;
  }
  return pixels_[index(row, column)];
}

Eigen::Vector3d RangeImage::nearestPoint(int row, int column) const {
  return double(around(row, column).nearest) * directionOf(projection_, {row, column});
}

}  // namespace gaussmap
