// SPDX-License-Identifier: BSD-3-Clause
#include "registration/map_neighbours.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>

namespace gaussmap {
namespace {

// What the axes other than the thinnest tell at the finest scale: scan lines on a plane look thin along two axes, and
// they move with the sensor.
constexpr double kLine = 0.03;
constexpr double kFilled = 0.6;  // of the variance of a full cell: more is full, counted with few points

}  // namespace

void MapNeighbours::setBlur(double blur) {
  blur_ = blur;
  for (std::size_t i = 0; i < candidates_.size(); ++i) candidates_[i].information = widened(found_[i].index);
}

Matrix<3> MapNeighbours::widened(std::size_t index) const {
  const Matrix<3> cov = map_.localGaussian(index, scale_).cov + blur_ * blur_ * Matrix<3>::Identity();
  return cov.inverse();
}

std::uint32_t MapNeighbours::candidate(std::size_t index) {
  if (place_[index] == kNone) {
    place_[index] = static_cast<std::uint32_t>(candidates_.size());
    candidates_.push_back({map_.gaussian(index, scale_).mean - origin_, widened(index)});
    found_.push_back({index, {}});
  }
  return place_[index];
}

void MapNeighbours::prepare(std::uint32_t i) {
  if (found_[i].worked_out) return;
  const PrincipalAxes<3> axes = principalAxes(map_.localGaussian(found_[i].index, scale_));
  MapGaussian made{candidates_[i].mean, axes.directions, axes.variances, {}};
  // A uniform density from side to side has a variance of side^2 / 12: such an axis ends where the cell does.
  const double whole = map_.grid().side(scale_) * map_.grid().side(scale_) / 12.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double open = std::max(0.0, 1.0 - made.variances[axis] / (kFilled * whole));
    made.tells[axis] = (axis > 0 && scale_ == 0 ? kLine : 1.0) * open * open;
  }
  found_[i].worked_out = made;
}

const std::vector<std::uint32_t>& MapNeighbours::gaussiansIn(const CellKey<3>& key) {
  const std::uint32_t hash = KeyIndex::hashOf(key);
  const std::uint32_t known = cells_.index.find(hash, [&](std::uint32_t i) { return cells_.keys[i] == key; });
  if (known != kNone) return cells_.gaussians[known];
  std::vector<std::uint32_t> all;
  if (const auto cell = map_.find(key, scale_)) {
    const IndexRange range = map_.gaussiansOf(*cell, scale_);
    for (std::size_t i = range.first; i < range.last; ++i) all.push_back(candidate(i));
  }
  cells_.index.insert(hash, static_cast<std::uint32_t>(cells_.keys.size()));
  cells_.keys.push_back(key);
  cells_.gaussians.push_back(std::move(all));
  return cells_.gaussians.back();
}

std::uint32_t MapNeighbours::listAt(const Vector<3>& point) {
  CellKey<3> low;  // of the eight cells, the one of lowest coordinates
  try {
    low = map_.grid().keyOf(point + origin_ - Vector<3>::Constant(0.5 * map_.grid().side(scale_)), scale_);
  } catch (const std::out_of_range&) {
    return kNone;
  }
  const std::uint32_t hash = KeyIndex::hashOf(low);
  const std::uint32_t known = lists_.index.find(hash, [&](std::uint32_t i) { return lists_.keys[i] == low; });
  if (known != kNone) return known;
  std::vector<std::uint32_t> list;
  for (int corner = 0; corner < 8; ++corner) {
    CellKey<3> key = low;
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      inside = inside && !__builtin_add_overflow(key[axis], (corner >> axis) & 1, &key[axis]);
    if (!inside) continue;
    const std::vector<std::uint32_t>& more = gaussiansIn(key);
    list.insert(list.end(), more.begin(), more.end());
  }
  const auto made = static_cast<std::uint32_t>(lists_.keys.size());
  lists_.keys.push_back(low);
  lists_.gaussians.push_back(std::move(list));
  lists_.index.insert(hash, made);
  return made;
}

std::uint32_t MapNeighbours::nearest(std::uint32_t list, const Vector<3>& point) const {
  std::uint32_t nearest = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t i : lists_.gaussians[list]) {
    const Matrix<3>& info = candidates_[i].information;
    const double x = point.x() - candidates_[i].mean.x(), y = point.y() - candidates_[i].mean.y(),
                 z = point.z() - candidates_[i].mean.z();
    const double squared = info(0, 0) * x * x + info(1, 1) * y * y + info(2, 2) * z * z +
                           2.0 * (info(0, 1) * x * y + info(0, 2) * x * z + info(1, 2) * y * z);
    if (squared < least) {
      least = squared;
      nearest = i;
    }
  }
  return nearest;
}

}  // namespace gaussmap
