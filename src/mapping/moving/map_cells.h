// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// The cells of a finished map as visitVisible() wants them.
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

}  // namespace gaussmap::detail
