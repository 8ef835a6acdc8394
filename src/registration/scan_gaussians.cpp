// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_gaussians.h"

#include <algorithm>
#include <cmath>

namespace gaussmap::detail {

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

template std::vector<Gaussian<2>> gaussiansOf<2>(const GaussianMap<2>&, double, std::size_t);
template std::vector<Gaussian<3>> gaussiansOf<3>(const GaussianMap<3>&, double, std::size_t);

}  // namespace gaussmap::detail
