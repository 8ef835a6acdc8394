// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/in_space.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns a planar map as a map in space, for functions that show or write Gaussians in space.
///
/// The scales, the weights, the links and the log-odds are the same. Cell (x, y) becomes cell (x, y, 0). All means lie
/// in the plane z = 0, which is the lower face of these cells. The standard deviation across the plane is
/// MapOptions::noise. The finest scale holds Gaussians instead of moments, so the result accepts no scans.
GAUSSMAP_API GaussianMap<3> inSpace(const GaussianMap<2>& map);

}  // namespace gaussmap::detail
