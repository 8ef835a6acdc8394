// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/grid.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/check.h"
#include "core/floor_divide.h"
#include "map/lattice.h"

namespace gaussmap {
using namespace detail;

namespace {

// Limit of the coarsest side divided by the noise floor. Beyond it, the condition number of a covariance of the
// coarsest scale can exceed 1e14, too much for doubles.
constexpr double kMaxSidesPerNoise = 1e7;
constexpr std::int64_t kMaxCellsAlongSide = std::int64_t{1} << 30;

}  // namespace

template <int D>
std::string toString(const CellKey<D>& key) {
  std::string text = "(";
  for (std::size_t axis = 0; axis < D; ++axis) text += (axis ? ", " : "") + std::to_string(key[axis]);
  return text + ")";
}

template <int D>
bool isInBox(const Box<D>& box, const Vector<D>& point) {
  return (point.array() >= box.low.array()).all() && (point.array() < box.high.array()).all();
}

template <int D>
Grid<D>::Grid(const MapOptions& options) : options_(options) {
  require(std::isfinite(options.resolution) && options.resolution > 0.0, "resolution", options.resolution,
          "the side of a cell must be a positive number of metres");
  require(options.ratio >= 2, "ratio", options.ratio, "a coarser cell must be at least twice as wide");
  require(options.scales >= 1, "scales", options.scales, "must be at least 1");
  if (options_.noise == 0.0) options_.noise = options.resolution / 20.0;
  require(std::isfinite(options_.noise) && options_.noise > 0.0, "noise", options.noise,
          "the noise floor must be positive (0 = resolution / 20)");
  std::int64_t span = 1;
  for (int scale = 0; scale < options.scales; ++scale) {
    if (scale > 0) span *= options.ratio;
    require(span <= kMaxCellsAlongSide, "scales", options.scales,
            "the coarsest cell must not be wider than 2^30 finest cells: take fewer scales or a smaller ratio");
    spans_.push_back(span);
    sides_.push_back(options.resolution * static_cast<double>(span));
  }
  require(sides_.back() <= kMaxSidesPerNoise * options_.noise, "noise", options_.noise,
          "must be at least 1e-7 of the coarsest cell's side: take fewer scales or more noise");
}

template <int D>
CellKey<D> Grid<D>::keyOf(const Vector<D>& point, int scale) const {
  const double steps_per_metre = stepsPerMetre(options_.resolution);
  CellKey<D> key;
  for (int axis = 0; axis < D; ++axis) {
    const std::int64_t lattice = snap(point(axis) * steps_per_metre);
    if (misfitsLattice(lattice)) throwOutsideLattice(point.data(), D, options_.resolution);
    key[static_cast<std::size_t>(axis)] = cellOfLattice(lattice);
  }
  return scale == 0 ? key : ancestor(key, 0, scale);
}

template <int D>
CellKey<D> Grid<D>::ancestor(const CellKey<D>& key, int from, int to) const {
  const std::int64_t span = cellsAlongSide(to) / cellsAlongSide(from);
  CellKey<D> ancestor;
  for (std::size_t axis = 0; axis < D; ++axis) ancestor[axis] = static_cast<std::int32_t>(floorDivide(key[axis], span));
  return ancestor;
}

template <int D>
Vector<D> Grid<D>::centre(const CellKey<D>& key, int scale) const {
  Vector<D> centre;
  for (int axis = 0; axis < D; ++axis) {
    // Counts in half finest cells, an integer. The rounding is then the same as for the finest cells around it.
    const std::int64_t halves = (2 * std::int64_t{key[static_cast<std::size_t>(axis)]} + 1) * cellsAlongSide(scale);
    centre(axis) = 0.5 * static_cast<double>(halves) * options_.resolution;
  }
  return centre;
}

template <int D>
Box<D> Grid<D>::boxOf(const CellKey<D>& key, int scale) const {
  const Vector<D> middle = centre(key, scale);
  const double half = 0.5 * side(scale);
  return {(middle.array() - half).matrix(), (middle.array() + half).matrix()};
}

template <int D>
Vector<D> Grid<D>::centreInParent(const CellKey<D>& key, int scale) const {
  return centreInParent(key, ancestor(key, scale, scale + 1), scale);
}

template <int D>
Vector<D> Grid<D>::centreInParent(const CellKey<D>& key, const CellKey<D>& parent, int scale) const {
  Vector<D> offset;
  for (int axis = 0; axis < D; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const std::int64_t digit = key[i] - std::int64_t{parent[i]} * options_.ratio;
    offset(axis) = 0.5 * static_cast<double>(2 * digit + 1 - options_.ratio) * side(scale);
  }
  return offset;
}

template std::string toString<2>(const CellKey<2>&);
template std::string toString<3>(const CellKey<3>&);
template bool isInBox<2>(const Box<2>&, const Vector<2>&);
template bool isInBox<3>(const Box<3>&, const Vector<3>&);
template class Grid<2>;
template class Grid<3>;

}  // namespace gaussmap
