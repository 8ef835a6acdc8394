// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "registration/planar_neighbours.h"

namespace gaussmap::detail {

/// One scale of a map, paired with a planar scan.
struct PlanarScale {
  PlanarNeighbours near;
  double blur;  ///< of the last step of the scale [m]
};

/// Returns the information that the normals of the walls give about the pose of a planar scan. It has the form of
/// PlanarEquations::information, with a weight of at most 1 per Gaussian of the scan. See sumOfNormals() for the
/// reason. `scales`: finest first.
Eigen::Matrix3d sumOfWallNormals(const std::vector<Gaussian<2>>& scan, std::vector<PlanarScale>& scales,
                                 const PlanarPose& pose, double kernel);

}  // namespace gaussmap::detail
