// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/core/gaussian.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"

namespace gaussmap::detail {

/// Returns the information that the normals of the map's surfaces give about the pose of a scan. It has the form of
/// NormalEquations::information, with a weight of at most 1 per Gaussian of the scan.
///
/// The information of the registration itself is too large. It also counts the border of the mapped area, the scan
/// lines of a lidar on a plane, and the errors of normals. These move with the sensor, or are random, so they do not
/// determine the pose. This function leaves them out. The normal of a Gaussian of the scan comes from the finest scale
/// of the map that has a clear normal there, because a lidar with few scan lines shows planes only in wide cells. If
/// the scan is large, an even selection of its Gaussians is used.
///
/// `scales`: the neighbours of each scale, finest first, with their blur. `lines`: the scan is that of a planar laser,
/// so its lines are surfaces. `kernel`: as in RegistrationOptions.
NormalEquations::Matrix6 sumOfNormals(const std::vector<Gaussian<3>>& scan, const std::vector<MapNeighbours*>& scales,
                                      const Pose& pose, double kernel, bool lines);

}  // namespace gaussmap::detail
