// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/gaussian/gaussian.h"
#include "gaussmap/registration/registration.h"

namespace gaussmap {

/// The Gaussians of a scan that are moved onto the map, scan frame: one a cell, evenly chosen.
std::vector<Gaussian<3>> gaussiansOf(const std::vector<Eigen::Vector3d>& points, double resolution,
                                     const RegistrationOptions& options);
/// Those of the scale of a map whose cells are nearest to that.
std::vector<Gaussian<3>> gaussiansOf(const GaussianMap<3>& map, double resolution, const RegistrationOptions& options);

}  // namespace gaussmap
