// SPDX-License-Identifier: BSD-3-Clause
#include "registration/residual_batch.h"

#include "core/function_clones.h"

namespace gaussmap::detail {
namespace {

using Lanes = ResidualBatch::Lanes;
constexpr std::size_t kLanes = ResidualBatch::kLanes;
constexpr double kNear = 9.0;  // 3 standard deviations, squared

struct Motion {
  double rotation[3][3], translation[3];
  double blur_squared, per_squared_kernel;
};

/// Sums of the normal equations. Symmetric matrices are stored as their upper triangles, row by row.
struct Sums {
  Lanes shifts[6], shift_turns[9], turns[6];  // of J' W J
  Lanes shift[3], turn[3];                    // of the gradient
  Lanes cost, near, near_squared;
};

GAUSSMAP_CLONES void addAll(const ResidualBatch::Columns& in, std::size_t blocks, const Motion& motion, Sums& sums) {
  const Lanes none{}, one = none + 1.0;
  const auto& r = motion.rotation;
  for (std::size_t i = 0; i < blocks; ++i) {
    const Lanes x = in.mean[0][i], y = in.mean[1][i], z = in.mean[2][i];
    const Lanes ax = r[0][0] * x + r[0][1] * y + r[0][2] * z;  // the arm: R m
    const Lanes ay = r[1][0] * x + r[1][1] * y + r[1][2] * z;
    const Lanes az = r[2][0] * x + r[2][1] * y + r[2][2] * z;
    const Lanes dx = ax + motion.translation[0] - in.target[0][i], dy = ay + motion.translation[1] - in.target[1][i],
                dz = az + motion.translation[2] - in.target[2][i];
    const Lanes sxx = in.cov[0][i], sxy = in.cov[1][i], sxz = in.cov[2][i], syy = in.cov[3][i], syz = in.cov[4][i],
                szz = in.cov[5][i];
    Lanes squared = none, gx = none, gy = none, gz = none;
    Lanes mxx = none, mxy = none, mxz = none, myy = none, myz = none, mzz = none;  // M = sum of a w a'
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Lanes nx = in.directions[axis][0][i], ny = in.directions[axis][1][i], nz = in.directions[axis][2][i];
      const Lanes tx = r[0][0] * nx + r[1][0] * ny + r[2][0] * nz;  // R' a
      const Lanes ty = r[0][1] * nx + r[1][1] * ny + r[2][1] * nz;
      const Lanes tz = r[0][2] * nx + r[1][2] * ny + r[2][2] * nz;
      const Lanes spread = tx * (sxx * tx + sxy * ty + sxz * tz) + ty * (sxy * tx + syy * ty + syz * tz) +
                           tz * (sxz * tx + syz * ty + szz * tz);
      const Lanes information = in.tells[axis][i] / (in.variances[axis][i] + motion.blur_squared + spread);
      const Lanes error = nx * dx + ny * dy + nz * dz, pull = information * error;
      squared += pull * error;
      gx += pull * nx, gy += pull * ny, gz += pull * nz;
      const Lanes wx = information * nx, wy = information * ny, wz = information * nz;
      mxx += wx * nx, mxy += wx * ny, mxz += wx * nz, myy += wy * ny, myz += wy * nz, mzz += wz * nz;
    }
    const Lanes share = one / (one + squared * motion.per_squared_kernel), weight = share * share;
    mxx *= weight, mxy *= weight, mxz *= weight, myy *= weight, myz *= weight, mzz *= weight;
    gx *= weight, gy *= weight, gz *= weight;
    // A rotation by the vector u moves the mean by u x arm. So a row of the block B (shifts, turns) is arm x (row of
    // M), and a column of the block (turns, turns) is arm x (column of B).
    const Lanes bxx = ay * mxz - az * mxy, bxy = az * mxx - ax * mxz, bxz = ax * mxy - ay * mxx;
    const Lanes byx = ay * myz - az * myy, byy = az * mxy - ax * myz, byz = ax * myy - ay * mxy;
    const Lanes bzx = ay * mzz - az * myz, bzy = az * mxz - ax * mzz, bzz = ax * myz - ay * mxz;
    sums.shifts[0] += mxx, sums.shifts[1] += mxy, sums.shifts[2] += mxz;
    sums.shifts[3] += myy, sums.shifts[4] += myz, sums.shifts[5] += mzz;
    sums.shift_turns[0] += bxx, sums.shift_turns[1] += bxy, sums.shift_turns[2] += bxz;
    sums.shift_turns[3] += byx, sums.shift_turns[4] += byy, sums.shift_turns[5] += byz;
    sums.shift_turns[6] += bzx, sums.shift_turns[7] += bzy, sums.shift_turns[8] += bzz;
    sums.turns[0] += ay * bzx - az * byx, sums.turns[1] += ay * bzy - az * byy, sums.turns[2] += ay * bzz - az * byz;
    sums.turns[3] += az * bxy - ax * bzy, sums.turns[4] += az * bxz - ax * bzz, sums.turns[5] += ax * byz - ay * bxz;
    sums.shift[0] += gx, sums.shift[1] += gy, sums.shift[2] += gz;
    sums.turn[0] += ay * gz - az * gy, sums.turn[1] += az * gx - ax * gz, sums.turn[2] += ax * gy - ay * gx;
    sums.cost += squared * share;
    const Lanes near = squared <= kNear ? one : none;
    sums.near += near, sums.near_squared += near * squared;
  }
}

double total(const Lanes& lanes) {
  double sum = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) sum += lanes[lane];
  return sum;
}

}  // namespace

void ResidualBatch::add(const Gaussian<3>& gaussian, const MapGaussian& target) {
  const std::size_t block = size_ / kLanes, lane = size_ % kLanes;
  ++size_;
  for (int axis = 0; axis < 3; ++axis) {
    columns_.mean[axis][block][lane] = gaussian.mean[axis];
    columns_.target[axis][block][lane] = target.mean[axis];
    for (int row = 0; row < 3; ++row) columns_.directions[axis][row][block][lane] = target.directions(row, axis);
    columns_.variances[axis][block][lane] = target.variances[axis];
    columns_.tells[axis][block][lane] = target.tells[axis];
  }
  for (int row = 0, k = 0; row < 3; ++row)
    for (int column = row; column < 3; ++column, ++k) columns_.cov[k][block][lane] = gaussian.cov(row, column);
}

NormalEquations ResidualBatch::sumUp(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
                                     double blur_squared, double kernel) {
  Motion motion{{}, {}, blur_squared, 1.0 / (kernel * kernel)};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) motion.rotation[row][column] = rotation(row, column);
    motion.translation[row] = translation[row];
  }
  const std::size_t met = size_;
  const MapGaussian tells_nothing{Vector<3>::Zero(), Matrix<3>::Zero(), Vector<3>::Ones(), Vector<3>::Zero()};
  while (size_ % kLanes != 0) add({Vector<3>::Zero(), Matrix<3>::Zero(), 0.0}, tells_nothing);
  const std::size_t padding = size_ - met;
  Sums lanes{};
  addAll(columns_, size_ / kLanes, motion, lanes);
  NormalEquations sums;
  for (int row = 0, k = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column, ++k) {
      sums.information(row, column) = sums.information(column, row) = total(lanes.shifts[k]);
      sums.information(row + 3, column + 3) = sums.information(column + 3, row + 3) = total(lanes.turns[k]);
    }
    for (int column = 0; column < 3; ++column)
      sums.information(row, column + 3) = sums.information(column + 3, row) =
          total(lanes.shift_turns[3 * row + column]);
    sums.gradient[row] = total(lanes.shift[row]);
    sums.gradient[row + 3] = total(lanes.turn[row]);
  }
  sums.cost = total(lanes.cost);
  sums.met = met;
  sums.near = static_cast<std::size_t>(total(lanes.near)) - padding;
  sums.near_squared = total(lanes.near_squared);
  size_ = 0;
  return sums;
}

}  // namespace gaussmap::detail
