// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/registration/registration.h"
#include "registration/observability.h"
#include "registration/planar_equations.h"

namespace gaussmap::detail {

/// The Gaussians that represent a planar scan, relative to the sensor.
struct PlanarScan {
  std::vector<Gaussian<2>> fine, coarse;  ///< `coarse` is for coarse scales of the map
  double side = 0.0;                      ///< side of the cells of `fine` [m]
  double range = 0.0;                     ///< RMS range [m]

  /// `fine` comes from the scale of `source` whose cells have about this side, `coarse` from that with about four times
  /// the side. Each has at most `most` Gaussians.
  PlanarScan(const GaussianMap<2>& source, double side, std::size_t most);
};

/// The result of a search that ends at the finest scale of the map.
struct PlanarFit {
  PlanarPose pose;                                     ///< relative to the origin of the search
  PlanarEquations equations;                           ///< at `pose`
  Eigen::Matrix3d surfaces = Eigen::Matrix3d::Zero();  ///< sumOfWallNormals() at `pose`
  int iterations = 0;
  bool converged = false;
};

/// Searches the pose of a scan from a start, without moving it along the held directions. One search begins at every
/// scale of the map, and the one with the smallest final cost is returned. All coordinates are relative to `origin` [m,
/// map frame], so that they keep their precision far from zero.
PlanarFit searchInPlane(const PlanarScan& scan, const GaussianMap<2>& map, const PlanarPose& start,
                        const Vector<2>& origin, const HeldPlanarDirections& held, const RegistrationOptions& options);

}  // namespace gaussmap::detail
