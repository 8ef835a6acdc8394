// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "editing/keep_cells.h"
#include "gaussmap/io/gmap/map_file.h"
#include "io/gmap/quantise.h"

namespace gaussmap {
using namespace detail;

template <int D>
GaussianMap<D> finish(const GaussianMap<D>& map, int finest_scale) {
  if (finest_scale < 0 || finest_scale >= map.scales())
    throw std::out_of_range("scale " + std::to_string(finest_scale) + ": the map has the scales 0 to " +
                            std::to_string(map.scales() - 1));
  std::vector<std::vector<char>> keep;
  keep.reserve(std::size_t(map.scales()));
  for (int s = 0; s < map.scales(); ++s) keep.emplace_back(map.cellCount(s), s >= finest_scale ? 1 : 0);
  const GaussianMap<D> thin = keepCells<D>(map, keep);
  std::vector<MapScale<D>> scales;
  for (int s = 0; s < map.scales(); ++s) {
    scales.push_back(thin.scale(s));
    MapScale<D>& scale = scales.back();
    scale.gaussians.clear();
    for (std::size_t i = 0; i < thin.gaussianCount(s); ++i)
      scale.gaussians.push_back(dequantise<D>(quantise<D>(thin.localGaussian(i, s), map.options().noise),
                                              map.options().noise, map.grid().side(s)));
    scale.moments.clear();
    for (float& log_odds : scale.log_odds) log_odds = dequantiseLogOdds(quantiseLogOdds(log_odds));
  }
  return GaussianMap<D>(map.options(), std::move(scales));
}

template GaussianMap<2> finish<2>(const GaussianMap<2>&, int);
template GaussianMap<3> finish<3>(const GaussianMap<3>&, int);

}  // namespace gaussmap
