// SPDX-License-Identifier: BSD-3-Clause
#include "map/inherit_occupancy.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace gaussmap::detail {

template <int D>
void inheritOccupancy(const MapScale<D>& finer, MapScale<D>& coarse) {
  if (finer.log_odds.empty()) return;
  constexpr float kNothingYet = std::numeric_limits<float>::lowest();
  std::vector<float> highest(coarse.gaussianCount(), kNothingYet);
  for (std::size_t i = 0; i < finer.parent.size(); ++i)
    highest[finer.parent[i]] = std::max(highest[finer.parent[i]], finer.log_odds[i]);
  for (std::size_t i = 0; i < highest.size(); ++i)
    if (highest[i] == kNothingYet) highest[i] = coarse.log_odds.empty() ? kMaxOccupancy : coarse.log_odds[i];
  coarse.log_odds = std::move(highest);
}

template <int D>
GaussianMap<D> withOccupancy(const GaussianMap<D>& map, const std::vector<float>& log_odds) {
  if (log_odds.size() != map.gaussianCount(0))
    throw std::invalid_argument(std::to_string(log_odds.size()) + " occupancies given for " +
                                std::to_string(map.gaussianCount(0)) +
                                " Gaussians of the finest scale: one per Gaussian is needed");
  std::vector<MapScale<D>> scales;
  scales.reserve(std::size_t(map.scales()));
  for (int s = 0; s < map.scales(); ++s) scales.push_back(map.scale(s));
  scales.front().log_odds = log_odds;
  for (std::size_t s = 1; s < scales.size(); ++s) inheritOccupancy<D>(scales[s - 1], scales[s]);
  return GaussianMap<D>(map.options(), std::move(scales));
}

#define GAUSSMAP_INSTANTIATE(D)                                        \
  template void inheritOccupancy<D>(const MapScale<D>&, MapScale<D>&); \
  template GaussianMap<D> withOccupancy<D>(const GaussianMap<D>&, const std::vector<float>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
