// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_gaussians.h"

#include <algorithm>
#include <cmath>

#include "gaussmap/map/moment_grid.h"

namespace gaussmap {
namespace {

/// Every so manyeth of `count`, `most` of them.
std::vector<std::size_t> evenly(std::size_t count, std::size_t most) {
  const std::size_t taken = std::min(count, most);
  std::vector<std::size_t> chosen(taken);
  for (std::size_t i = 0; i < taken; ++i) chosen[i] = i * count / taken;
  return chosen;
}

}  // namespace

std::vector<Gaussian<3>> gaussiansOf(const std::vector<Eigen::Vector3d>& points, double resolution,
                                     const RegistrationOptions& options) {
  const Grid<3> grid({resolution, 2, 1, 0.0});
  MomentGrid<3> sums(resolution);
  sums.addPoints(points);
  std::vector<std::size_t> order(sums.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  // By key: neither the order of the points nor that of the scanner decides what is taken.
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return sums[a].key < sums[b].key; });
  std::vector<Gaussian<3>> gaussians;
  for (const std::size_t i : evenly(order.size(), options.most_gaussians)) {
    const auto& cell = sums[order[i]];
    gaussians.push_back(cell.moments.gaussian(resolution, grid.options().noise));
    gaussians.back().mean += grid.centre(cell.key, 0);
  }
  return gaussians;
}

std::vector<Gaussian<3>> gaussiansOf(const GaussianMap<3>& map, double resolution, const RegistrationOptions& options) {
  int scale = 0;
  const auto off = [&](int s) { return std::abs(std::log(map.grid().side(s) / resolution)); };
  for (int s = 1; s < map.scales(); ++s)
    if (map.gaussianCount(scale) == 0 || off(s) < off(scale)) scale = s;
  std::vector<Gaussian<3>> gaussians;
  for (const std::size_t i : evenly(map.gaussianCount(scale), options.most_gaussians))
    gaussians.push_back(map.gaussian(i, scale));
  return gaussians;
}

}  // namespace gaussmap
