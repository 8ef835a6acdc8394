// SPDX-License-Identifier: BSD-3-Clause
#include "registration/normal_equations.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t kPart = 256;  // Gaussians that are summed by themselves: the order of the sums is fixed
constexpr double kNear = 9.0;       // squared standard deviations

void addResidual(const Gaussian<3>& gaussian, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
                 const MapGaussian& target, double blur_squared, double kernel, NormalEquations& sums) {
  const Eigen::Vector3d arm = rotation * gaussian.mean, difference = arm + translation - target.mean;
  Eigen::Vector3d error, information;  // along the axes of the target
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = target.directions.col(axis), turned = rotation.transpose() * direction;
    error[axis] = direction.dot(difference);
    information[axis] =
        target.tells[axis] / (target.variances[axis] + blur_squared + turned.dot(gaussian.cov * turned));
  }
  const double squared = (information.array() * error.array().square()).sum();
  const double over = 1.0 + squared / (kernel * kernel), weight = 1.0 / (over * over);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(information[axis] > 0.0)) continue;
    NormalEquations::Vector6 slope;  // of the error
    slope << target.directions.col(axis), arm.cross(target.directions.col(axis));
    const NormalEquations::Vector6 weighted = weight * information[axis] * slope;
    sums.information.noalias() += weighted * slope.transpose();
    sums.gradient += error[axis] * weighted;
  }
  sums.cost += squared / over;
  ++sums.met;
  if (squared > kNear) return;
  ++sums.near;
  sums.near_squared += squared;
}

}  // namespace

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  information += other.information;
  gradient += other.gradient;
  cost += other.cost;
  met += other.met;
  near += other.near;
  near_squared += other.near_squared;
  return *this;
}

void addResidual(const Gaussian<3>& gaussian, const Pose& pose, const MapGaussian& target, double blur_squared,
                 double kernel, NormalEquations& sums) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  addResidual(gaussian, rotation, pose.translation, target, blur_squared, kernel, sums);
}

NormalEquations linearise(const std::vector<Gaussian<3>>& scan, const Pose& pose, MapNeighbours& near, double kernel,
                          int threads) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const auto placed = [&](std::size_t i) -> Vector<3> { return rotation * scan[i].mean + pose.translation; };
  std::vector<std::uint32_t> met(scan.size());  // list, then the nearest of it
  for (std::size_t i = 0; i < scan.size(); ++i) met[i] = near.listAt(placed(i));
  parallelFor(scan.size(), threads, kPart, [&](std::size_t i) {
    if (met[i] != MapNeighbours::kNone) met[i] = near.nearest(met[i], placed(i));
  });
  for (const std::uint32_t i : met)
    if (i != MapNeighbours::kNone) near.prepare(i);
  const double blur_squared = near.blur() * near.blur();
  std::vector<NormalEquations> parts((scan.size() + kPart - 1) / kPart);
  parallelFor(parts.size(), threads, 1, [&](std::size_t part) {
    NormalEquations& sums = parts[part];
    for (std::size_t i = part * kPart; i < std::min(scan.size(), (part + 1) * kPart); ++i) {
      if (met[i] != MapNeighbours::kNone)
        addResidual(scan[i], rotation, pose.translation, near[met[i]], blur_squared, kernel, sums);
      else
        sums.cost += kernel * kernel;
    }
  });
  NormalEquations all;
  for (const NormalEquations& part : parts) all += part;
  all.information = 0.5 * (all.information + all.information.transpose()).eval();
  return all;
}

Pose moved(const Pose& pose, const NormalEquations::Vector6& by) {
  const Eigen::Vector3d turn = by.tail<3>();
  const double angle = turn.norm();
  Pose result = pose;
  result.translation += by.head<3>();
  if (angle > 0.0)
    result.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * Eigen::Quaterniond(pose.rotation);
  return normalised(result);
}

}  // namespace gaussmap
