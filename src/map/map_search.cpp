// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <limits>

#include "gaussmap/map/queries.h"
#include "map/check_query.h"
#include "map/map_means.h"
#include "points/nearest_list.h"
#include "points/neighbour_tree.h"

namespace gaussmap {
using namespace detail;

/// The means, relative to a point near the middle of the map, so that they keep their digits far from the origin.
template <int D>
struct MapSearch<D>::Parts {
  using Tree = NeighbourTree<double>;
  using Entry = Neighbour<double, std::uint32_t>;

  explicit Parts(const GaussianMap<D>& map) : grid(map.grid()) {
    const int coarsest = map.scales() - 1;
    const std::size_t cells = map.cellCount(coarsest);
    if (cells > 0) origin = grid.centre(map.scale(coarsest).keys[cells / 2], coarsest);
  }

  /// Appends the means of one cell.
  void addCell(const GaussianMap<D>& map, std::size_t cell, int s, std::vector<typename Tree::Point>& points) const {
    const Vector<D> centre = grid.centre(map.scale(s).keys[cell], s) - origin;
    const IndexRange range = map.gaussiansOf(cell, s);
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Vector<D> mean = centre + localMean<D>(map, i, s);
      typename Tree::Point point{{}, static_cast<std::uint32_t>(points.size())};
      for (int axis = 0; axis < D; ++axis) point.at[static_cast<std::size_t>(axis)] = mean(axis);
      points.push_back(point);
    }
  }

  /// Returns the query relative to the origin.
  std::array<double, 3> query(const Vector<D>& point) const {
    checkQuery(grid, point);
    std::array<double, 3> query{};
    for (int axis = 0; axis < D; ++axis) query[static_cast<std::size_t>(axis)] = point(axis) - origin(axis);
    return query;
  }

  FoundGaussian result(const Entry& entry) const {
    const double distance = std::sqrt(entry.distance);
    if (ids.empty()) return {{scale, entry.index}, distance};
    return {ids[entry.index], distance};
  }

  template <typename List>
  std::vector<FoundGaussian> search(const Vector<D>& point, List list) const {
    const std::array<double, 3> at = query(point);
    tree.search(at, list);
    std::vector<FoundGaussian> found;
    for (const Entry& entry : list.sort()) found.push_back(result(entry));
    return found;
  }

  Grid<D> grid;
  Vector<D> origin = Vector<D>::Zero();  // [m, map frame]
  Tree tree;
  int scale = 0;                // of all means, if there are no ids
  std::vector<GaussianId> ids;  // per mean, in the order of leaves()
};

template <int D>
MapSearch<D>::MapSearch(const GaussianMap<D>& map) {
  if (!map.isCompressed()) {
    *this = MapSearch(map, 0);
    return;
  }
  const auto parts = std::make_shared<Parts>(map);
  std::vector<typename Parts::Tree::Point> points;
  for (int s = 0; s < map.scales(); ++s)
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell)
      if (map.isLeaf(cell, s)) parts->addCell(map, cell, s, points);
  parts->ids = leaves(map);
  parts->tree = typename Parts::Tree(points);
  parts_ = parts;
}

template <int D>
MapSearch<D>::MapSearch(const GaussianMap<D>& map, int scale) {
  checkScale(map, scale);
  const auto parts = std::make_shared<Parts>(map);
  std::vector<typename Parts::Tree::Point> points;
  points.reserve(map.gaussianCount(scale));
  for (std::size_t cell = 0; cell < map.cellCount(scale); ++cell) parts->addCell(map, cell, scale, points);
  parts->scale = scale;
  parts->tree = typename Parts::Tree(points);
  parts_ = parts;
}

template <int D>
std::size_t MapSearch<D>::size() const {
  return parts_->tree.size();
}

template <int D>
std::optional<FoundGaussian> MapSearch<D>::nearest(const Vector<D>& point) const {
  const std::array<double, 3> at = parts_->query(point);
  if (size() == 0) return std::nullopt;
  NearestOne<double, std::uint32_t> one(kAnyDistance);
  parts_->tree.search(at, one);
  return parts_->result(one.best());
}

template <int D>
std::vector<FoundGaussian> MapSearch<D>::nearestK(const Vector<D>& point, int k) const {
  checkCount(k);
  checkQuery(parts_->grid, point);
  if (k == 0) return {};
  return parts_->search(point, NearestList<double, std::uint32_t>(static_cast<std::size_t>(k), kAnyDistance));
}

template <int D>
std::vector<FoundGaussian> MapSearch<D>::within(const Vector<D>& point, double radius) const {
  checkRadius(radius);
  const double above = radius * radius * (1.0 + 8.0 * std::numeric_limits<double>::epsilon());  // before rounding
  std::vector<FoundGaussian> found = parts_->search(point, NeighboursWithin<double, std::uint32_t>(above));
  while (!found.empty() && found.back().distance > radius) found.pop_back();
  return found;
}

template class MapSearch<2>;
template class MapSearch<3>;

}  // namespace gaussmap
