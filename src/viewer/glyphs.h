// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/queries.h"

namespace gaussmap {

/// What turns a unit sphere into one Gaussian's ellipsoid: p -> centre + R diag(half_axes) p.
struct Glyph {
  std::array<float, 3> centre;     ///< [m], about an origin near the map: floats lose nothing
  std::array<float, 4> rotation;   ///< R: w x y z, unit
  std::array<float, 3> half_axes;  ///< [m], ascending
};

/// One for every Gaussian, the ellipsoid at `sigma` standard deviations, centre about `origin`.
/// Throws std::domain_error if a covariance is not finite.
std::vector<Glyph> ellipsoidGlyphs(const GaussianMap<3>& map, const std::vector<GaussianId>& gaussians, double sigma,
                                   const Vector<3>& origin);

/// Middle of the occupied cells [m]; zero for an empty map.
Vector<3> middleOf(const GaussianMap<3>& map);

}  // namespace gaussmap
