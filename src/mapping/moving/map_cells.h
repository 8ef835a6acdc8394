// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/sensor/visibility.h"

namespace gaussmap::detail {

/// Gives visitVisible() access to the cells of a complete map.
struct MapCells {
  const GaussianMap<3>& map;

  int scales() const { return map.scales(); }
  std::size_t rootCount() const { return map.cellCount(map.scales() - 1); }
  Eigen::Vector3d centre(std::size_t cell, int scale) const {
    return map.grid().centre(map.scale(scale).keys[cell], scale);
  }
  double radius(int scale) const { return 0.5 * std::sqrt(3.0) * map.grid().side(scale); }
  template <typename Body>
  void forChildren(std::size_t cell, int scale, const Body& body) const {
    const IndexRange children = map.childCells(cell, scale);
    for (std::size_t child = children.first; child < children.last; ++child) body(child);
  }
};

/// Gives the functions of object_rules.h access to the finest cells of a complete map.
struct FinestMapCells {
  using Index = std::size_t;
  static constexpr int kDimensions = 3;

  const GaussianMap<3>& map;
  const std::vector<Evidence>& seen;  // one per cell

  std::size_t slots() const { return map.cellCount(0); }
  double side() const { return map.grid().side(0); }
  const CellKey<3>& key(Index cell) const { return map.scale(0).keys[cell]; }
  std::optional<Index> find(const CellKey<3>& key) const { return map.find(key, 0); }
  const Evidence& evidence(Index cell) const { return seen[cell]; }
  Vector<3> mean(Index cell) const { return map.localGaussian(cell, 0).mean; }
};

}  // namespace gaussmap::detail
