// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

/// One Gaussian of a map.
struct GaussianId {
  int scale = 0;
  std::size_t index = 0;  ///< in its scale
  friend bool operator==(const GaussianId& a, const GaussianId& b) { return a.scale == b.scale && a.index == b.index; }
};

/// All Gaussians of one scale, in its order. Throws std::out_of_range for a scale that the map does not have.
template <int D>
std::vector<GaussianId> gaussiansOfScale(const GaussianMap<D>& map, int scale);

/// The map at its finest: the Gaussians of the finest scale, and where compress() deleted them, those of the coarse
/// cell that stands there instead. Together they stand for every point once. Finest first, each scale in its order. Of
/// a map that is not compressed: its finest scale.
template <int D>
std::vector<GaussianId> leaves(const GaussianMap<D>& map);

/// How much of a scale is the finest that the map has there (GaussianMap::isLeaf()).
struct LeafCounts {
  std::size_t cells = 0;
  std::size_t gaussians = 0;
  double weight = 0.0;  ///< points
};
template <int D>
LeafCounts leafCounts(const GaussianMap<D>& map, int scale);

}  // namespace gaussmap
