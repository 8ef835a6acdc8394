// SPDX-License-Identifier: BSD-3-Clause
#include "registration/wall_normals.h"

#include <algorithm>
#include <cstddef>

namespace gaussmap::detail {
namespace {

// As in sumOfNormals().
constexpr double kEnoughNormals = 0.95;  // a Gaussian with this weight of normals needs no coarser scale
constexpr double kThinWall = 2.0;        // standard deviation of a thin wall, in units of the blur of the finest scale
constexpr double kTiltedNormal = 0.1;    // a normal with this variance of its tilt [rad^2] counts no more

/// Returns the variance of the tilt of the normal [rad^2], as for the eigenvectors of a sample's covariance. It is at
/// most 1.
double tiltOfWall(const PlanarTarget& target) {
  const double shorter = target.variances[0], longer = target.variances[1], gap = longer - shorter;
  const double points = std::max(1.0, target.count - 2.0);
  return shorter * longer < points * gap * gap ? shorter * longer / (points * gap * gap) : 1.0;
}

/// Returns how clearly the short axis is the normal of a wall, from 0 to 1.
double wallClearness(const PlanarTarget& target, double thin) {
  const double thinner = 1.0 - target.variances[0] / target.variances[1];
  const double steady = std::max(0.0, 1.0 - tiltOfWall(target) / kTiltedNormal);
  return target.tells[0] * thinner * thinner * steady * thin / (thin + target.variances[0]);
}

/// Returns n n' of the normal, without the part that comes from its tilt. On a wall, the tilts of the normals of few
/// noisy points would look like information about the direction along the wall.
Matrix<2> squareOfNormal(const PlanarTarget& target) {
  const Vector<2> normal = target.directions.col(0), along = target.directions.col(1);
  return normal * normal.transpose() - tiltOfWall(target) * along * along.transpose();
}

}  // namespace

Eigen::Matrix3d sumOfWallNormals(const std::vector<Gaussian<2>>& scan, std::vector<PlanarScale>& scales,
                                 const PlanarPose& pose, double kernel) {
  const Matrix<2> rotation = pose.rotation();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  if (scales.empty()) return sum;
  const double thin = kThinWall * kThinWall * scales.front().blur * scales.front().blur;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector<2> arm = rotation * scan[i].mean, place = arm + pose.position;
    Matrix<2> normals = Matrix<2>::Zero();
    double left = 1.0;  // weight that the coarser scales can add
    for (PlanarScale& scale : scales) {
      const PlanarTarget* const target = scale.near.nearest(i, place, scale.blur);
      if (target == nullptr) continue;
      const Vector<2> normal = target->directions.col(0), turned = rotation.transpose() * normal;
      const double variance = target->variances[0] + scale.blur * scale.blur + turned.dot(scan[i].cov * turned);
      const double error = normal.dot(place - target->mean);
      const double share = 1.0 / (1.0 + error * error / (variance * kernel * kernel));
      const double clear = wallClearness(*target, thin);
      normals += left * clear * share * share * squareOfNormal(*target);
      left *= 1.0 - clear;
      if (left < 1.0 - kEnoughNormals) break;
    }
    Eigen::Matrix<double, 2, 3> motion;  // of the mean, per unit of the pose
    motion << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
    sum += motion.transpose() * normals * motion;
  }
  return 0.5 * (sum + sum.transpose());
}

}  // namespace gaussmap::detail
