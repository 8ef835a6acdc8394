// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/culling.h"

#include <algorithm>

#include "sensor/default_lengths.h"

namespace gaussmap::detail {
namespace {

/// Returns a slightly larger radius, so that rounding does not exclude a point of the ball.
double withRounding(double radius) {
  return radius * (1.0 + 1e-6);
}

}  // namespace

Culling::Culling(const RangeImage& image, const VisibilityOptions& options)
    : image_(image), tolerance_(toleranceOf(options)) {
  Level level{image.rows(), image.columns(), {}};
  for (int row = 0; row < level.rows; ++row)
    for (int column = 0; column < level.columns; ++column) {
      const PixelRanges& ranges = image.at(row, column);
      level.farthest.push_back(ranges.empty() ? 0.0f : ranges.nearest);
    }
  levels_.push_back(std::move(level));
  while (levels_.back().rows > 1 || levels_.back().columns > 1) {
    const Level& fine = levels_.back();
    Level coarse{(fine.rows + 1) / 2, (fine.columns + 1) / 2, {}};
    coarse.farthest.assign(std::size_t(coarse.rows) * std::size_t(coarse.columns), 0.0f);
    for (int row = 0; row < fine.rows; ++row)
      for (int column = 0; column < fine.columns; ++column) {
        float& pixel = coarse.farthest[std::size_t(row / 2) * std::size_t(coarse.columns) + std::size_t(column / 2)];
        pixel = std::max(pixel, fine.farthest[std::size_t(row) * std::size_t(fine.columns) + std::size_t(column)]);
      }
    levels_.push_back(std::move(coarse));
  }
}

float Culling::farthestIn(int first_row, int last_row, int first_column, int last_column) const {
  std::size_t k = 0;  // a level on which the box is at most three pixels wide and high
  for (int size = std::max(last_row - first_row, last_column - first_column); size > 1; size /= 2) ++k;
  k = std::min(k, levels_.size() - 1);
  const Level& level = levels_[k];
  float farthest = 0.0f;
  for (int row = first_row >> k; row <= last_row >> k; ++row)
    for (int column = first_column >> k; column <= last_column >> k; ++column)
      farthest =
          std::max(farthest, level.farthest[std::size_t(row) * std::size_t(level.columns) + std::size_t(column)]);
  return farthest;
}

double Culling::farthestAround(const Eigen::Vector3d& centre, double radius) const {
  const PixelBox box = pixelsOf(image_.projection(), centre, radius);
  if (box.empty()) return 0.0;
  // visibilityOf() also uses the neighbours of a point's pixel.
  const int first_row = std::max(0, box.first_row - 1), last_row = std::min(image_.rows() - 1, box.last_row + 1);
  int first = box.first_column - 1, last = box.last_column + 1;
  const int columns = image_.columns();
  float farthest = 0.0f;
  if (wraps(image_.projection())) {
    if (first < 0) {
      farthest = farthestIn(first_row, last_row, std::max(0, first + columns), columns - 1);
      first = 0;
    }
    if (last >= columns) {
      farthest = std::max(farthest, farthestIn(first_row, last_row, 0, std::min(columns - 1, last - columns)));
      last = columns - 1;
    }
  } else {
    first = std::max(0, first);
    last = std::min(columns - 1, last);
  }
  if (first <= last) farthest = std::max(farthest, farthestIn(first_row, last_row, first, last));
  return double(farthest);
}

bool Culling::mayPassThrough(const Eigen::Vector3d& centre, double ball_radius) const {
  const double radius = withRounding(ball_radius);
  const double nearest = std::max(0.0, centre.norm() - radius);
  if (nearest + tolerance_ >= double(image_.farthest())) return false;
  return farthestAround(centre, radius) > nearest + tolerance_;
}

bool Culling::maySee(const Eigen::Vector3d& centre, double ball_radius) const {
  const double radius = withRounding(ball_radius);
  const double nearest = std::max(0.0, centre.norm() - radius);
  if (nearest - tolerance_ > double(image_.farthest())) return false;
  const double farthest = farthestAround(centre, radius);
  return farthest > 0.0 && farthest >= nearest - tolerance_;
}

}  // namespace gaussmap::detail
