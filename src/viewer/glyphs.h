// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/queries.h"

namespace gaussmap {

/// The transform of a unit sphere to the ellipsoid of one Gaussian: p -> centre + R diag(half_axes) p.
struct Glyph {
  std::array<float, 3> centre;     ///< [m], relative to an origin near the map, so that floats are precise enough
  std::array<float, 4> rotation;   ///< R as unit quaternion w x y z
  std::array<float, 3> half_axes;  ///< [m], ascending
};

/// Returns one glyph per Gaussian: the ellipsoid at `sigma` standard deviations, with its centre relative to `origin`.
/// Throws std::domain_error if a covariance is not finite.
std::vector<Glyph> ellipsoidGlyphs(const GaussianMap<3>& map, const std::vector<GaussianId>& gaussians, double sigma,
                                   const Vector<3>& origin);

/// Returns the middle of the occupied cells [m]; zero for an empty map.
Vector<3> middleOf(const GaussianMap<3>& map);

}  // namespace gaussmap
