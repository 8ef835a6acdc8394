// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Returns the part of a map that lies inside a region.
///
/// `isInside` receives the mean [m, map frame] of each Gaussian in a leaf cell (see GaussianMap::isLeaf()) and returns
/// true to keep the Gaussian. Kept Gaussians do not change, and keep their exact moments. A coarse Gaussian becomes the
/// moment match of its remaining children if some are lost, and is deleted if all are lost.
///
/// The disjoint parts of a map can be merged again with mergeMaps(). The finest scale is then exactly that of the map,
/// unless the map was compressed. The coarse scales can differ.
template <int D>
GAUSSMAP_API GaussianMap<D> crop(const GaussianMap<D>& map, const std::function<bool(const Vector<D>&)>& isInside);

/// A polygon in the xy plane. A point at any height is inside if its (x, y) is inside.
///
/// The corners are in order, clockwise or counter-clockwise. If sides cross, the even-odd rule applies. If two adjacent
/// polygons share a side (with the same two corners), a point on this side is inside exactly one of them.
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
