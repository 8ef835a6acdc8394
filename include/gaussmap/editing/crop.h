// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The part of a map whose Gaussians `isInside` takes, asked for the mean of each that has nothing finer under it
/// [m, map frame]. They stay as they are, exact moments too; a coarse cluster of which a part stays becomes the moment
/// match of that. Parts that share nothing merge to the finest scale of the whole again (mergeMaps()).
template <int D>
GAUSSMAP_API GaussianMap<D> crop(const GaussianMap<D>& map, const std::function<bool(const Vector<D>&)>& isInside);

/// Is (x, y) of a point inside a polygon, at any height? Corners in order, either way round; where its sides cross, by
/// the even-odd rule. Polygons that share a side share no point.
/// Throws std::invalid_argument if there are fewer than three corners or one is not finite.
class GAUSSMAP_API Polygon {
 public:
  explicit Polygon(std::vector<Vector<2>> corners);
  bool contains(double x, double y) const;

 private:
  std::vector<Vector<2>> corners_;
};

}  // namespace gaussmap
