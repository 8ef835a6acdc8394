// SPDX-License-Identifier: BSD-3-Clause
#include "registration/normal_equations.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "common/parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t kPart = 256;  // Gaussians that are summed by themselves: the order of the sums is fixed
constexpr double kNear = 9.0;       // squared standard deviations

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Distance for the search of the nearest: the covariance of the scan is left out.
double searchDistance(const Vector<3>& mean, const MapGaussian& target, double blur_squared) {
  const Vector<3> along = target.directions.transpose() * (mean - target.mean);
  return (along.array().square() / (target.variances.array() + blur_squared)).sum();
}

void addResidual(const Residual& r, const Eigen::Vector3d& arm, double kernel, NormalEquations& sums) {
  const double over = 1.0 + r.squared / (kernel * kernel), weight = 1.0 / (over * over);
  const Eigen::Matrix3d info = weight * r.information;
  const Eigen::Matrix3d cross = skew(arm);  // J = [I, -skew(arm)]
  const Eigen::Matrix3d right = -info * cross;
  sums.information.topLeftCorner<3, 3>() += info;
  sums.information.topRightCorner<3, 3>() += right;
  sums.information.bottomRightCorner<3, 3>() += cross * right;  // -cross' = cross
  const Eigen::Vector3d pull = info * r.difference;
  sums.gradient.head<3>() += pull;
  sums.gradient.tail<3>() += cross * pull;
  sums.cost += r.squared / over;
  ++sums.met;
  if (r.squared > kNear) return;
  ++sums.near;
  sums.near_squared += r.squared;
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

Residual residual(const Vector<3>& mean, const Matrix<3>& cov, const MapGaussian& target, double blur_squared) {
  Residual r;
  r.difference = mean - target.mean;
  r.information.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = target.directions.col(axis);
    const double variance = target.variances[axis] + blur_squared + direction.dot(cov * direction);
    r.information += target.tells[axis] / variance * direction * direction.transpose();
  }
  r.squared = r.difference.dot(r.information * r.difference);
  return r;
}

NormalEquations linearise(const std::vector<Gaussian<3>>& scan, const Pose& pose, MapNeighbours& near, double blur,
                          double kernel, int threads) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  std::vector<std::uint32_t> lists(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) lists[i] = near.listAt(rotation * scan[i].mean + pose.translation);
  std::vector<NormalEquations> parts((scan.size() + kPart - 1) / kPart);
  parallelFor(parts.size(), threads, 1, [&](std::size_t part) {
    NormalEquations& sums = parts[part];
    for (std::size_t i = part * kPart; i < std::min(scan.size(), (part + 1) * kPart); ++i) {
      const Eigen::Vector3d arm = rotation * scan[i].mean, mean = arm + pose.translation;
      const MapGaussian* nearest = nullptr;
      double least = std::numeric_limits<double>::infinity();
      if (lists[i] != MapNeighbours::kNone)
        for (const std::uint32_t candidate : near.list(lists[i])) {
          const double distance = searchDistance(mean, near[candidate], blur * blur);
          if (distance < least) {
            least = distance;
            nearest = &near[candidate];
          }
        }
      if (nearest)
        addResidual(residual(mean, rotation * scan[i].cov * rotation.transpose(), *nearest, blur * blur), arm, kernel,
                    sums);
      else
        sums.cost += kernel * kernel;
    }
  });
  NormalEquations all;
  for (const NormalEquations& part : parts) all += part;
  all.information.bottomLeftCorner<3, 3>() = all.information.topRightCorner<3, 3>().transpose();
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
