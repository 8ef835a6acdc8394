// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_gaussians.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace gaussmap::detail {
namespace {

// Largest thickness of a plane / its extent, squared: points that were rounded to floats.
constexpr double kFlat = 1e-9;
constexpr double kNarrow = 0.1;  // of a line or a disc: the smaller variance is at most this part of the larger one

}  // namespace

template <int D>
std::vector<Gaussian<D>> gaussiansOf(const GaussianMap<D>& source, double side, std::size_t most) {
  int scale = 0;
  const auto off = [&](int s) { return std::abs(std::log(source.grid().side(s) / side)); };
  for (int s = 1; s < source.scales(); ++s)
    if (source.gaussianCount(scale) == 0 || off(s) < off(scale)) scale = s;
  const std::size_t count = source.gaussianCount(scale), taken = std::min(count, most);
  std::vector<Gaussian<D>> gaussians;
  gaussians.reserve(taken);
  for (std::size_t i = 0; i < taken; ++i) gaussians.push_back(source.gaussian(i * count / taken, scale));
  return gaussians;
}

template <int D>
double rmsRangeOf(const std::vector<Gaussian<D>>& scan) {
  double squared = 0.0;
  for (const Gaussian<D>& gaussian : scan) squared += gaussian.mean.squaredNorm() / double(scan.size());
  return std::max(1e-6, std::sqrt(squared));
}
template double rmsRangeOf(const std::vector<Gaussian<2>>&);
template double rmsRangeOf(const std::vector<Gaussian<3>>&);

bool isOfPlanarLaser(const std::vector<Gaussian<3>>& scan) {
  if (scan.size() < 4) return false;
  Vector<3> centre = Vector<3>::Zero();
  for (const Gaussian<3>& gaussian : scan) centre += gaussian.mean / double(scan.size());
  Matrix<3> scatter = Matrix<3>::Zero();
  for (const Gaussian<3>& gaussian : scan) scatter += (gaussian.mean - centre) * (gaussian.mean - centre).transpose();
  const Vector<3> spread = Eigen::SelfAdjointEigenSolver<Matrix<3>>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  if (spread[0] > kFlat * spread[2]) return false;
  std::size_t lines = 0, discs = 0;
  for (const Gaussian<3>& gaussian : scan) {
    const Vector<3> variances = principalAxes(gaussian).variances;
    const bool is_line = variances[1] <= kNarrow * variances[2];
    lines += is_line;
    discs += !is_line && variances[0] <= kNarrow * variances[1];
  }
  return lines > discs;
}

template std::vector<Gaussian<2>> gaussiansOf<2>(const GaussianMap<2>&, double, std::size_t);
template std::vector<Gaussian<3>> gaussiansOf<3>(const GaussianMap<3>&, double, std::size_t);

}  // namespace gaussmap::detail
