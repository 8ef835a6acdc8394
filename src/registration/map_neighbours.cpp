// SPDX-License-Identifier: BSD-3-Clause
#include "registration/map_neighbours.h"

#include <algorithm>
#include <stdexcept>

#include "mapping/near_cells.h"

namespace gaussmap {
namespace {

constexpr double kFilled = 0.6;  // of the variance of a full cell: more is full, counted with few points

}  // namespace

std::uint32_t MapNeighbours::gaussian(std::size_t index) {
  if (place_[index] != kNone) return place_[index];
  const Gaussian<3> gaussian = map_.gaussian(index, scale_);
  const PrincipalAxes<3> axes = principalAxes(gaussian);
  MapGaussian made{gaussian.mean - origin_, axes.directions, axes.variances, {}};
  // A uniform density from side to side has a variance of side^2 / 12: such an axis ends where the cell does.
  const double whole = map_.grid().side(scale_) * map_.grid().side(scale_) / 12.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double open = std::max(0.0, 1.0 - made.variances[axis] / (kFilled * whole));
    made.tells[axis] = open * open;
  }
  gaussians_.push_back(made);
  return place_[index] = static_cast<std::uint32_t>(gaussians_.size() - 1);
}

std::uint32_t MapNeighbours::listAt(const Vector<3>& point) {
  CellKey<3> key;
  try {
    key = map_.grid().keyOf(point + origin_, scale_);
  } catch (const std::out_of_range&) {
    return kNone;
  }
  const std::uint32_t hash = KeyIndex::hashOf(key);
  const std::uint32_t found = index_.find(hash, [&](std::uint32_t i) { return keys_[i] == key; });
  if (found != kNone) return found;
  std::vector<std::uint32_t> list;
  const auto take = [&](const CellKey<3>& near) {
    const auto cell = map_.find(near, scale_);
    if (!cell) return;
    const IndexRange range = map_.gaussiansOf(*cell, scale_);
    for (std::size_t i = range.first; i < range.last; ++i) list.push_back(gaussian(i));
  };
  take(key);
  forNearKeys(key, 1, 1, take);
  keys_.push_back(key);
  lists_.push_back(std::move(list));
  const auto made = static_cast<std::uint32_t>(keys_.size() - 1);
  index_.insert(hash, made);
  return made;
}

}  // namespace gaussmap
