// SPDX-License-Identifier: BSD-3-Clause
// Registration in the plane: only x, y and the heading move.
#include <Eigen/Geometry>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "core/about_z.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/registration/registration.h"
#include "registration/check_options.h"
#include "registration/observability.h"
#include "registration/planar_search.h"
#include "registration/steps.h"

namespace gaussmap {
using namespace detail;

namespace {

/// The rotation of a pose: a tilt, followed by a rotation about z by the heading.
struct HeadingAndTilt {
  double heading = 0.0;                              // [rad]
  Pose::Rotation tilt = Pose::Rotation::Identity();  // without a rotation about z

  explicit HeadingAndTilt(const Pose::Rotation& rotation) {
    heading = 2.0 * std::atan2(rotation.z(), rotation.w());
    if (rotation.x() == 0.0 && rotation.y() == 0.0) return;  // exactly planar
    tilt = aboutZ(heading).conjugate() * rotation;
  }

  Pose::Rotation at(double new_heading) const {
    if (tilt.x() == 0.0 && tilt.y() == 0.0) return aboutZ(new_heading);  // exactly planar
    return Pose::Rotation(aboutZ(new_heading) * tilt).normalized();
  }
};

/// Returns the points without their height, in the frame of the sensor after it was levelled.
std::vector<Vector<2>> levelled(const std::vector<Eigen::Vector3d>& points, const Pose::Rotation& tilt) {
  std::vector<Vector<2>> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3d& point : points)
    if (point.allFinite()) flat.push_back((tilt * point).head<2>());
  return flat;
}

RegistrationResult alignInPlane(const GaussianMap<2>& source, const GaussianMap<2>& map, double side, const Pose& guess,
                                const RegistrationOptions& options) {
  RegistrationResult result;
  result.pose = normalised(guess);
  const PlanarScan scan(source, side, options.max_gaussians);
  if (scan.fine.empty()) return result;
  const HeadingAndTilt start(result.pose.rotation);
  const Vector<2> origin = guess.translation.head<2>();
  // Which directions are unobservable is clear only at the end of a search. By then, the coarse scales may have moved
  // the pose along them, towards the borders of the seen area. So the search starts again, and holds them.
  HeldPlanarDirections held(scan.range);
  PlanarFit found;
  do {
    found = searchInPlane(scan, map, {Vector<2>::Zero(), start.heading}, origin, held, options);
    result.iterations += found.iterations;
    if (found.equations.met < kFewestPairs || !(found.surfaces.trace() > 0.0)) return result;
  } while (held.hold(found.surfaces, options.degenerate));
  const Eigen::Vector3d least = leastObservable(found.surfaces, scan.range);
  result.least_observable << least.x(), least.y(), 0.0, 0.0, 0.0, least.z();
  result.pose.translation.head<2>() = origin + found.pose.position;
  result.pose.rotation = start.at(found.pose.heading);
  result.converged = found.converged;
  result.fitness = double(found.equations.near) / double(scan.fine.size());
  if (found.equations.near > 0) result.mean_squared = found.equations.near_squared / double(found.equations.near);
  result.degenerate = !held.isEmpty();
  const Eigen::Matrix3d covariance = held.covarianceOf(found.equations.information);
  constexpr int kAxes[3] = {0, 1, 5};  // x, y, rotation about z
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) result.covariance(kAxes[row], kAxes[column]) = covariance(row, column);
  return result;
}

double sideFor(const GaussianMap<2>& map, const RegistrationOptions& options) {
  return options.resolution > 0.0 ? options.resolution : map.grid().side(0);
}

}  // namespace

RegistrationResult registerScan(const std::vector<Eigen::Vector3d>& points, const GaussianMap<2>& map,
                                const Pose& guess, const RegistrationOptions& options) {
  checkRegistration(map.empty(), guess, options);
  const double side = sideFor(map, options);
  const HeadingAndTilt start(normalised(guess).rotation);
  return alignInPlane(build<2>(levelled(points, start.tilt), {side, kCoarse, 2, 0.0}), map, side, guess, options);
}

RegistrationResult registerMap(const GaussianMap<2>& source, const GaussianMap<2>& map, const Pose& guess,
                               const RegistrationOptions& options) {
  checkRegistration(map.empty(), guess, options);
  if (guess.translation.z() != 0.0 || guess.rotation.x() != 0.0 || guess.rotation.y() != 0.0) {
    std::ostringstream text;
    text << "guess: the motion of a 2-D map is not planar: the translation has z = " << guess.translation.z()
         << " and the quaternion x = " << guess.rotation.x() << ", y = " << guess.rotation.y() << ", all must be 0";
    throw std::invalid_argument(text.str());
  }
  return alignInPlane(source, map, sideFor(map, options), guess, options);
}

}  // namespace gaussmap
