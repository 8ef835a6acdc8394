// SPDX-License-Identifier: BSD-3-Clause
#include "editing/restore_clusters.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/number_text.h"
#include "gaussmap/core/cell_moments.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/inherit_occupancy.h"

namespace gaussmap::detail {
namespace {

/// Throws std::invalid_argument unless a finest cluster has moments and their mean lies in its cell of this grid.
template <int D>
void checkSums(const RemovedCluster<D>& one, const Grid<D>& grid) {
  const std::string name = "the cluster of cell " + toString<D>(one.key);
  if (one.moments.count == 0)
    throw std::invalid_argument(name + " has no moments: it was deleted with --learning-rate occupancy");
  const double side = grid.side(0);
  const Vector<D> from_sums = grid.centre(one.key, 0) + one.moments.mean(side);
  // The mean far from the origin is rounded, hence the tolerance. In a grid of another resolution, the cell with this
  // key is somewhere else.
  if (!((from_sums - one.gaussian.mean).norm() <= 1e-3 * side) || grid.keyOf(from_sums) != one.key)
    throw std::invalid_argument(name + " does not lie in this cell of a map with cells of " + numberText(side) +
                                " m: it was deleted from a map of another resolution");
}

/// Returns the moments of the map together with those of the removed clusters inside, and counts these clusters.
template <int D>
MomentGrid<D> sumsOf(const GaussianMap<D>& map, const std::vector<RemovedCluster<D>>& removed,
                     const std::function<bool(const Vector<D>&)>& isInside, std::size_t& clusters) {
  MomentGrid<D> sums(map.grid().side(0));
  std::int64_t most = 0;
  for (std::size_t i = 0; i < map.cellCount(0); ++i) {
    sums.add(map.scale(0).keys[i], map.scale(0).moments[i]);
    most = std::max(most, map.scale(0).moments[i].count);
  }
  for (const RemovedCluster<D>& one : removed) {
    if (one.scale > 0) continue;  // coarse scales are rebuilt
    checkSums(one, map.grid());
    if (!isInside(one.gaussian.mean)) continue;
    most += one.moments.count;
    if (most > CellMoments<D>::kMaxPoints)
      throw std::invalid_argument("too many points: a cell could hold more than 2^33 - 1; restore fewer clusters");
    sums.add(one.key, one.moments);
    ++clusters;
  }
  return sums;
}

/// Returns the log-odds of the finest cells. Restored cells get the maximum, because the user knows that something is
/// there.
template <int D>
std::vector<float> occupancyAfter(const GaussianMap<D>& map, const GaussianMap<D>& old) {
  std::vector<float> log_odds;
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    const std::optional<std::size_t> before = old.find(map.scale(0).keys[cell], 0);
    const bool is_as_before = before && old.scale(0).moments[*before] == map.scale(0).moments[cell];
    log_odds.push_back(is_as_before ? old.logOdds(*before, 0) : kMaxOccupancy);
  }
  return log_odds;
}

template <int D>
GaussianMap<D> rebuilt(const MomentGrid<D>& sums, const GaussianMap<D>& old, int threads) {
  GaussianMap<D> map = build<D>(sums, old.options());
  if (old.hasOccupancy()) map = withOccupancy<D>(map, occupancyAfter(map, old));
  RefineOptions options;
  MaxGaussians budget;
  options.threads = threads;
  bool is_unrefined = true;
  for (int s = 1; s < map.scales(); ++s) {
    budget.by_scale[s] = std::max(old.gaussianCount(s), map.cellCount(s));
    is_unrefined = is_unrefined && budget.by_scale[s] == map.cellCount(s);
  }
  return is_unrefined ? map : refine<D>(std::move(map), budget, options).map;
}

}  // namespace

template <int D>
RestoredMap<D> restoreClusters(const GaussianMap<D>& map, const std::vector<RemovedCluster<D>>& removed,
                               const std::function<bool(const Vector<D>&)>& isInside, int threads) {
  if (!map.acceptsScans()) throw std::invalid_argument("restore: the map has no moments");
  RestoredMap<D> restored;
  const MomentGrid<D> sums = sumsOf(map, removed, isInside, restored.clusters);
  restored.points = sums.pointCount() - static_cast<std::int64_t>(map.weight(0));
  restored.map = rebuilt(sums, map, threads);
  return restored;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                              \
  template RestoredMap<D> restoreClusters<D>(const GaussianMap<D>&, const std::vector<RemovedCluster<(D)>>&, \
                                             const std::function<bool(const Vector<(D)>&)>&, int);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
