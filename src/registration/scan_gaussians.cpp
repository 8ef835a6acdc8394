// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_gaussians.h"

#include <algorithm>
#include <cmath>

namespace gaussmap::detail {

std::vector<Gaussian<3>> gaussiansOf(const GaussianMap<3>& source, double side, std::size_t most) {
  int scale = 0;
  const auto off = [&](int s) { return std::abs(std::log(source.grid().side(s) / side)); };
  for (int s = 1; s < source.scales(); ++s)
    if (source.gaussianCount(scale) == 0 || off(s) < off(scale)) scale = s;
  const std::size_t count = source.gaussianCount(scale), taken = std::min(count, most);
  std::vector<Gaussian<3>> gaussians;
  gaussians.reserve(taken);
  for (std::size_t i = 0; i < taken; ++i) gaussians.push_back(source.gaussian(i * count / taken, scale));
  return gaussians;
}

}  // namespace gaussmap::detail
