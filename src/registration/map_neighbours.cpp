// SPDX-License-Identifier: BSD-3-Clause
#include "registration/map_neighbours.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>

namespace gaussmap::detail {
namespace {

// Weight of the axes other than the thinnest at the finest scale. Scan lines on a plane look thin along two axes, but
// they move with the sensor.
constexpr double kLine = 0.03;
// An axis fills its cell from this share of a full cell's variance on, because a few points rarely reach all of it.
constexpr double kFilled = 0.6;

/// Compares two keys inline. The comparison of two std::array calls a function.
bool isSame(const CellKey<3>& a, const CellKey<3>& b) {
  return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0;
}

}  // namespace

MapNeighbours::MapNeighbours(const GaussianMap<3>& map, int scale, const Vector<3>& origin)
    : map_(map), scale_(scale), origin_(origin), half_side_(0.5 * map.grid().side(scale)) {}

void MapNeighbours::setBlur(double blur) {
  blur_ = blur;
  for (std::size_t i = 0; i < candidates_.size(); ++i) widen(i);
}

void MapNeighbours::widen(std::size_t i) {
  const Matrix<3> info = (cov_[i] + blur_ * blur_ * Matrix<3>::Identity()).inverse();
  Candidate& candidate = candidates_[i];
  candidate.xx = info(0, 0), candidate.yy = info(1, 1), candidate.zz = info(2, 2);
  candidate.xy = 2.0 * info(0, 1), candidate.xz = 2.0 * info(0, 2), candidate.yz = 2.0 * info(1, 2);
}

void MapNeighbours::addCandidates(Cell& cell) {
  cell.first = static_cast<std::uint32_t>(candidates_.size());
  const Vector<3> centre = map_.grid().centre(cell.key, scale_);
  const IndexRange range = map_.gaussiansOf(cell.index, scale_);
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Gaussian<3> gaussian = map_.localGaussian(i, scale_);
    const Vector<3> mean = gaussian.mean + centre - origin_;
    candidates_.push_back({mean.x(), mean.y(), mean.z(), 0, 0, 0, 0, 0, 0});
    cov_.push_back(gaussian.cov);
    count_.push_back(gaussian.weight);
    place_.push_back(kNone);
    widen(candidates_.size() - 1);
  }
}

void MapNeighbours::workOut(std::uint32_t i) {
  const Candidate& candidate = candidates_[i];
  const PrincipalAxes<3> axes = principalAxes(Gaussian<3>{Vector<3>::Zero(), cov_[i], 1.0});
  MapGaussian made{{candidate.x, candidate.y, candidate.z}, axes.directions, axes.variances, {}, count_[i]};
  // A uniform density over the whole cell has a variance of side^2 / 12. The end of such an axis is the end of the
  // cell, not that of a surface.
  const double whole = map_.grid().side(scale_) * map_.grid().side(scale_) / 12.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double open = std::max(0.0, 1.0 - made.variances[axis] / (kFilled * whole));
    made.tells[axis] = (axis > 0 && scale_ == 0 ? kLine : 1.0) * open * open;
  }
  place_[i] = static_cast<std::uint32_t>(worked_out_.size());
  worked_out_.push_back(made);
}

/// Enters all children of a parent at once, because the neighbours of a cell are needed next.
void MapNeighbours::enterCellsUnder(const CellKey<3>& parent) {
  const std::uint32_t hash = KeyIndex::hashOf(parent);
  if (parent_index_.find(hash, [&](std::uint32_t i) { return isSame(parents_[i], parent); }) != kNone) return;
  parent_index_.insert(hash, static_cast<std::uint32_t>(parents_.size()));
  parents_.push_back(parent);
  const auto found = map_.find(parent, scale_ + 1);
  if (!found) return;
  const IndexRange under = map_.childCells(*found, scale_ + 1);
  for (std::size_t i = under.first; i < under.last; ++i) {
    const CellKey<3>& key = map_.scale(scale_).keys[i];
    cell_index_.insert(KeyIndex::hashOf(key), static_cast<std::uint32_t>(cells_.size()));
    cells_.push_back({key, i});
  }
}

std::uint32_t MapNeighbours::findList(const Vector<3>& point) {
  CellKey<3> low;  // of the eight cells, the one with the lowest coordinates
  try {
    low = map_.grid().keyOf(point + origin_ - Vector<3>::Constant(half_side_), scale_);
  } catch (const std::out_of_range&) {
    return kNone;
  }
  const std::uint32_t hash = KeyIndex::hashOf(low);
  const std::uint32_t known = list_index_.find(hash, [&](std::uint32_t i) { return isSame(low_[i], low); });
  if (known != kNone) return known;
  const std::size_t first = members_.size();
  const bool is_top = scale_ + 1 == map_.scales();
  CellKey<3> parent{};
  for (int corner = 0; corner < 8; ++corner) {
    CellKey<3> key = low;
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      inside = inside && !__builtin_add_overflow(key[axis], (corner >> axis) & 1, &key[axis]);
    if (!inside) continue;
    if (!is_top && (corner == 0 || !map_.grid().isParent(parent, key))) {
      parent = map_.grid().ancestor(key, scale_, scale_ + 1);
      enterCellsUnder(parent);
    }
    const std::uint32_t at = cellAt(key);
    if (at == kNone) continue;
    Cell& cell = cells_[at];
    if (cell.first == kNone) addCandidates(cell);
    const IndexRange range = map_.gaussiansOf(cell.index, scale_);
    for (std::uint32_t i = 0; i < range.last - range.first; ++i) members_.push_back(cell.first + i);
  }
  const auto made = static_cast<std::uint32_t>(low_.size());
  lists_.push_back(
      {map_.grid().centre(low, scale_) + Vector<3>::Constant(half_side_) - origin_, first, members_.size()});
  low_.push_back(low);
  list_index_.insert(hash, made);
  return made;
}

std::uint32_t MapNeighbours::cellAt(const CellKey<3>& key) {
  const std::uint32_t hash = KeyIndex::hashOf(key);
  const std::uint32_t known = cell_index_.find(hash, [&](std::uint32_t i) { return isSame(cells_[i].key, key); });
  if (known != kNone || scale_ + 1 < map_.scales()) return known;
  const auto found = map_.find(key, scale_);  // no parents at the coarsest scale
  if (!found) return kNone;
  const auto made = static_cast<std::uint32_t>(cells_.size());
  cell_index_.insert(hash, made);
  cells_.push_back({key, *found});
  return made;
}

std::uint32_t MapNeighbours::nearest(std::uint32_t list, const Vector<3>& point) const {
  std::uint32_t nearest = kNone;
  double least = std::numeric_limits<double>::infinity();
  const double px = point.x(), py = point.y(), pz = point.z();
  for (std::size_t k = lists_[list].first; k < lists_[list].last; ++k) {
    const std::uint32_t i = members_[k];
    const Candidate& of = candidates_[i];
    const double x = px - of.x, y = py - of.y, z = pz - of.z;
    const double squared = x * (of.xx * x + of.xy * y + of.xz * z) + y * (of.yy * y + of.yz * z) + z * (of.zz * z);
    const bool is_nearer = squared < least;
    nearest = is_nearer ? i : nearest;
    least = is_nearer ? squared : least;
  }
  return nearest;
}

}  // namespace gaussmap::detail
