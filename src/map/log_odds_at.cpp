// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/log_odds_at.h"

#include <limits>
#include <stdexcept>

namespace gaussmap {
namespace {

template <int D>
std::optional<CellKey<D>> cellOf(const GaussianMap<D>& map, const Vector<D>& point) {
  if (!point.allFinite()) return std::nullopt;
  try {
    return map.grid().keyOf(point);
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

}  // namespace

template <int D>
std::optional<float> logOddsAt(const GaussianMap<D>& map, const Vector<D>& point) {
  const auto key = cellOf(map, point);
  if (!key) return std::nullopt;
  for (int s = 0; s < map.scales(); ++s) {
    const auto cell = map.find(map.grid().ancestor(*key, 0, s), s);
    if (!cell) continue;
    if (!map.isLeaf(*cell, s)) return std::nullopt;  // its detail says that there is nothing
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    const IndexRange all = map.gaussiansOf(*cell, s);
    for (std::size_t i = all.first; i < all.last; ++i) {
      const double square = all.size() == 1 ? 0.0 : mahalanobisSquared<D>(point, map.gaussian(i, s));
      if (square >= least) continue;
      least = square;
      nearest = i;
    }
    return map.logOdds(nearest, s);
  }
  return std::nullopt;
}

template std::optional<float> logOddsAt<2>(const GaussianMap<2>&, const Vector<2>&);
template std::optional<float> logOddsAt<3>(const GaussianMap<3>&, const Vector<3>&);

}  // namespace gaussmap
