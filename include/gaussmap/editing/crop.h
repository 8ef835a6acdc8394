// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Returns the part of a map that lies inside a region.
///
/// The function `isInside` gets the mean of each Gaussian in a leaf cell [m, map frame]. Gaussians inside are kept
/// unchanged, with their exact moments. A coarse cluster with some of its children outside becomes the moment match of
/// the remaining children. If a map is cut into disjoint parts, mergeMaps() restores the finest scale of the whole map.
template <int D>
GAUSSMAP_API GaussianMap<D> crop(const GaussianMap<D>& map, const std::function<bool(const Vector<D>&)>& isInside);

/// A polygon in the xy plane. A point at any height is inside if its (x, y) is inside.
///
/// The corners are in order, clockwise or counter-clockwise. If sides cross, the even-odd rule applies. Two polygons
/// that share a side have no point in common.
class GAUSSMAP_API Polygon {
 public:
  /// Makes a polygon from its corners [m]. Throws std::invalid_argument if there are fewer than three corners or a
  /// corner is not finite.
  explicit Polygon(std::vector<Vector<2>> corners);
  /// Returns true if (x, y) lies inside the polygon [m].
  bool contains(double x, double y) const;

 private:
  std::vector<Vector<2>> corners_;
};

}  // namespace gaussmap
