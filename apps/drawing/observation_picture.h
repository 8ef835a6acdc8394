// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::app {

/// One observation of a laser in two forms: as a Gaussian and as particles.
struct ObservationPicture {
  std::string title;
  // In sensor space: x is the bearing [rad, sensor frame], y the range [m].
  Vector<2> measured{0.0, 0.0};           ///< the measurement
  Vector<2> deviation{0.0, 0.0};          ///< standard deviations of its noise
  std::vector<Vector<2>> sensed;          ///< the particles, without the error of the pose
  std::vector<Vector<2>> sensed_density;  ///< more particles of the same distribution, drawn pale
  // In the plane [m], map frame.
  Vector<2> sensor{0.0, 0.0};                           ///< position of the sensor
  Vector<2> end{0.0, 0.0};                              ///< end of the beam
  Matrix<2> covariance = Matrix<2>::Zero();             ///< of the end, from the linearised projection [m^2]
  std::vector<Vector<2>> projected, projected_density;  ///< the particles, with the error of the pose
};

/// Writes three SVG pictures beside each other: the Gaussian in sensor space (Leal 2000 Fig. 1), the particles there
/// (Fig. 2), and in the plane the projected particles over the ellipses of the linearised Gaussian. Ellipses are at 1,
/// 2 and 3 standard deviations. Throws FileError if the file cannot be written.
void drawObservation(const ObservationPicture& observation, const std::filesystem::path& path);

}  // namespace gaussmap::app
