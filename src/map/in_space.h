// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns a point of a planar map as a point in space: z = 0 [m, map frame].
inline Vector<3> inSpace(const Vector<2>& point) {
  return {point.x(), point.y(), 0.0};
}
/// Returns points of a planar map as points in space.
GAUSSMAP_API std::vector<Vector<3>> inSpace(const std::vector<Vector<2>>& points);

/// Returns a Gaussian of a planar map as a Gaussian in space: its mean has z = 0, and `noise` is its standard deviation
/// across the plane [m].
GAUSSMAP_API Gaussian<3> inSpace(const Gaussian<2>& gaussian, double noise);

/// Returns a planar map as a map in space, for everything that shows or writes Gaussians in space.
///
/// The scales, the weights, the links and the log-odds are the same. Cell (x, y) becomes cell (x, y, 0). All means lie
/// in the plane z = 0, which is the lower face of these cells. The standard deviation across the plane is
/// MapOptions::noise. The finest scale holds Gaussians instead of moments, so the result accepts no scans.
GAUSSMAP_API GaussianMap<3> inSpace(const GaussianMap<2>& map);

}  // namespace gaussmap::detail
