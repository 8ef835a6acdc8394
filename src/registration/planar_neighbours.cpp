// SPDX-License-Identifier: BSD-3-Clause
#include "registration/planar_neighbours.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>
#include <stdexcept>

namespace gaussmap::detail {
namespace {

// As in MapNeighbours: the weight of the longer axis at the finest scale, where the gaps between the beams look like
// ends; and the share of a full cell's variance from which on an axis fills its cell.
constexpr double kLongAxis = 0.03;
constexpr double kFullCell = 0.6;
constexpr double kNearSquared = 9.0;  // 3 standard deviations, squared

/// The residual of a pair along the axes of its target.
struct PlanarPair {
  Matrix<2> weights = Matrix<2>::Zero();  // sum over the axes a: a w a', w = weight / variance
  Vector<2> pull = Vector<2>::Zero();     // weights * residual
  double squared = 0.0;                   // squared Mahalanobis distance
};

PlanarPair pairOf(const Vector<2>& residual, const Matrix<2>& scan_cov, const PlanarTarget& target, double blur) {
  PlanarPair pair;
  for (int axis = 0; axis < 2; ++axis) {
    const Vector<2> along = target.directions.col(axis);
    const double variance = target.variances[axis] + blur * blur + along.dot(scan_cov * along);
    pair.weights += target.tells[axis] / variance * along * along.transpose();
  }
  pair.pull = pair.weights * residual;
  pair.squared = residual.dot(pair.pull);
  return pair;
}

/// Adds a pair to the equations. `arm`: from the sensor to the Gaussian of the scan [m], map axes.
void addPair(const PlanarPair& pair, const Vector<2>& arm, double kernel, PlanarEquations& sums) {
  Eigen::Matrix<double, 2, 3> jacobian;  // of the residual by (x, y, heading)
  jacobian << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
  const double share = 1.0 / (1.0 + pair.squared / (kernel * kernel)), weight = share * share;
  sums.information += weight * jacobian.transpose() * pair.weights * jacobian;
  sums.gradient += weight * jacobian.transpose() * pair.pull;
  sums.cost += pair.squared * share;
  ++sums.met;
  if (pair.squared > kNearSquared) return;
  ++sums.near;
  sums.near_squared += pair.squared;
}

}  // namespace

PlanarNeighbours::PlanarNeighbours(const GaussianMap<2>& map, int scale, const std::vector<Gaussian<2>>& scan,
                                   const Vector<2>& origin)
    : map_(map),
      scale_(scale),
      scan_(scan),
      origin_(origin),
      candidates_(scan.size()),
      place_(map.gaussianCount(scale), kNone) {}

std::uint32_t PlanarNeighbours::targetOf(std::size_t gaussian, const Vector<2>& centre) {
  if (place_[gaussian] != kNone) return place_[gaussian];
  const Gaussian<2> local = map_.localGaussian(gaussian, scale_);
  const PrincipalAxes<2> axes = principalAxes(local);
  PlanarTarget target{local.mean + centre - origin_, local.cov, axes.directions, axes.variances, {}, local.weight};
  const double whole = map_.grid().side(scale_) * map_.grid().side(scale_) / 12.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double open = std::max(0.0, 1.0 - axes.variances[axis] / (kFullCell * whole));
    target.tells[axis] = (axis > 0 && scale_ == 0 ? kLongAxis : 1.0) * open * open;
  }
  place_[gaussian] = static_cast<std::uint32_t>(targets_.size());
  targets_.push_back(target);
  return place_[gaussian];
}

void PlanarNeighbours::lookUp(Candidates& candidates, const Vector<2>& point) {
  const double half_side = 0.5 * map_.grid().side(scale_);
  CellKey<2> low;
  try {
    low = map_.grid().keyOf(point + origin_ - Vector<2>::Constant(half_side), scale_);
  } catch (const std::out_of_range&) {
    candidates = {{}, false, {}};
    return;
  }
  if (candidates.known && candidates.low == low) return;
  candidates = {low, true, {}};
  for (std::int32_t corner = 0; corner < 4; ++corner) {
    CellKey<2> key = low;
    if (__builtin_add_overflow(low[0], corner & 1, &key[0]) || __builtin_add_overflow(low[1], corner >> 1, &key[1]))
      continue;
    const std::optional<std::size_t> cell = map_.find(key, scale_);
    if (!cell) continue;
    const Vector<2> centre = map_.grid().centre(key, scale_);
    const IndexRange range = map_.gaussiansOf(*cell, scale_);
    for (std::size_t i = range.first; i < range.last; ++i) candidates.targets.push_back(targetOf(i, centre));
  }
}

const PlanarTarget* PlanarNeighbours::nearest(std::size_t i, const Vector<2>& point, double blur) {
  lookUp(candidates_[i], point);
  const PlanarTarget* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t place : candidates_[i].targets) {
    const PlanarTarget& target = targets_[place];
    const Vector<2> offset = point - target.mean;
    const Matrix<2> widened = target.cov + blur * blur * Matrix<2>::Identity();
    const double squared = offset.dot(widened.inverse() * offset);
    if (squared >= least) continue;
    least = squared;
    nearest = &target;
  }
  return nearest;
}

PlanarEquations PlanarNeighbours::linearise(const PlanarPose& pose, double blur, double kernel) {
  const Matrix<2> rotation = pose.rotation();
  PlanarEquations sums;
  for (std::size_t i = 0; i < scan_.size(); ++i) {
    const Vector<2> arm = rotation * scan_[i].mean, point = arm + pose.position;
    const PlanarTarget* const target = nearest(i, point, blur);
    if (target == nullptr) {
      sums.cost += kernel * kernel;
      continue;
    }
    const Matrix<2> cov = rotation * scan_[i].cov * rotation.transpose();
    addPair(pairOf(point - target->mean, cov, *target, blur), arm, kernel, sums);
  }
  return sums;
}

}  // namespace gaussmap::detail
