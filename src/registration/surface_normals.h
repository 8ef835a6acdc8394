// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/core/gaussian.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"

namespace gaussmap::detail {

/// Sums up what the normals of the map's surfaces say about the pose of a scan, in the form of
/// NormalEquations::information, with a weight of at most 1 per Gaussian of the scan.
///
/// The information of a registration also contains what only looks like information: the border of the area that was
/// seen, the lines that a lidar draws on a plane, and the errors of normals. All of these move with the sensor, or are
/// random. The sum of the normals leaves them out. Each Gaussian of the scan takes the normal from the finest scale of
/// the map that has a clear one at its place: a scan with few lines gives planes only in wide cells. A large scan is
/// represented by an even selection of its Gaussians.
///
/// `scales`: the neighbours of each scale, finest first, with their blur. `lines`: the scan is that of a planar laser,
/// so its lines are surfaces. `kernel`: as in RegistrationOptions.
NormalEquations::Matrix6 sumOfNormals(const std::vector<Gaussian<3>>& scan, const std::vector<MapNeighbours*>& scales,
                                      const Pose& pose, double kernel, bool lines);

}  // namespace gaussmap::detail
