// SPDX-License-Identifier: BSD-3-Clause
#include "registration/surface_normals.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace gaussmap::detail {
namespace {

constexpr std::size_t kMost = 1000;  // Gaussians of the scan: enough to see 0.3 % of them
constexpr double kEnough = 0.95;     // a Gaussian with this weight of normals needs no coarser scale
constexpr double kThin = 2.0;        // standard deviation of a thin Gaussian, in units of the blur of the finest scale
constexpr double kTilted = 0.1;      // a normal with this variance of its tilt [rad^2] counts no more

/// Returns the variance of the tilt of an axis towards a longer one [rad^2], as for the eigenvectors of a sample's
/// covariance. It is at most 1.
double tiltOf(const MapGaussian& gaussian, int axis, int other) {
  const double shorter = gaussian.variances[axis], longer = gaussian.variances[other], gap = longer - shorter;
  const double points = std::max(1.0, gaussian.count - 2.0);
  return shorter * longer < points * gap * gap ? shorter * longer / (points * gap * gap) : 1.0;
}

/// Returns how clearly an axis is the normal of a surface, from 0 to 1. It must be much thinner than the next axis: the
/// axes of a line or a ball are no normals. Its tilt must be small, and its variance not larger than `thin`: a wide
/// cell with a part of a curved surface has no normal.
double clearness(const MapGaussian& gaussian, int axis, double thin) {
  const double thinner = 1.0 - gaussian.variances[axis] / gaussian.variances[axis + 1];
  const double steady = std::max(0.0, 1.0 - tiltOf(gaussian, axis, axis + 1) / kTilted);
  return (axis == 0 ? gaussian.tells[0] : 1.0) * thinner * thinner * steady * thin / (thin + gaussian.variances[axis]);
}

/// Returns n n' of a normal, without the part that comes from its tilt. On a plane, the tilts of the normals of few
/// noisy points would look like information about the directions in the plane.
Matrix<3> squareOf(const MapGaussian& gaussian, int axis) {
  const Vector<3> normal = gaussian.directions.col(axis);
  Matrix<3> square = normal * normal.transpose();
  for (int other = axis + 1; other < 3; ++other) {
    const Vector<3> direction = gaussian.directions.col(other);
    square -= tiltOf(gaussian, axis, other) * direction * direction.transpose();
  }
  return square;
}

}  // namespace

NormalEquations::Matrix6 sumOfNormals(const std::vector<Gaussian<3>>& scan, const std::vector<MapNeighbours*>& scales,
                                      const Pose& pose, double kernel, bool lines) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  NormalEquations::Matrix6 sum = NormalEquations::Matrix6::Zero();
  if (scales.empty()) return sum;
  const double thin = kThin * kThin * scales.front()->blur() * scales.front()->blur();
  const std::size_t used = std::min(kMost, scan.size());
  for (std::size_t i = 0; i < used; ++i) {
    const Gaussian<3>& gaussian = scan[i * scan.size() / used];
    const Vector<3> arm = rotation * gaussian.mean, place = arm + pose.translation;
    Matrix<3> normals = Matrix<3>::Zero();
    double left = 1.0;  // weight that the coarser scales can add
    for (MapNeighbours* near : scales) {
      const std::uint32_t list = near->listAt(place);
      const std::uint32_t met = list == MapNeighbours::kNone ? list : near->nearest(list, place);
      if (met == MapNeighbours::kNone) continue;
      near->prepare(met);
      const MapGaussian& target = (*near)[met];
      double most = 0.0;
      for (int axis = 0; axis < (lines ? 2 : 1); ++axis) {
        const Vector<3> normal = target.directions.col(axis), turned = rotation.transpose() * normal;
        const double variance =
            target.variances[axis] + near->blur() * near->blur() + turned.dot(gaussian.cov * turned);
        const double error = normal.dot(place - target.mean);
        const double share = 1.0 / (1.0 + error * error / (variance * kernel * kernel));
        const double clear = clearness(target, axis, thin);
        normals += left * clear * share * share * squareOf(target, axis);
        most = std::max(most, clear);
      }
      left *= 1.0 - most;
      if (left < 1.0 - kEnough) break;
    }
    if (left == 1.0) continue;
    Eigen::Matrix<double, 3, 6> motion;  // of the mean, per unit of the pose
    motion.leftCols<3>().setIdentity();
    motion.rightCols<3>() << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(), 0.0;
    sum += motion.transpose() * normals * motion;
  }
  return 0.5 * (sum + sum.transpose());
}

}  // namespace gaussmap::detail
