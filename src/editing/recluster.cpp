// SPDX-License-Identifier: BSD-3-Clause
#include "editing/recluster.h"

#include <algorithm>
#include <utility>

#include "map/occupied_areas.h"

namespace gaussmap::detail {
namespace {

/// Groups the finer Gaussians of each cell by the old cluster that they come from. Sets `clusters` to the old cluster
/// of each new cluster.
template <int D>
ClusterCut cutByGroup(const ScalePair<D>& pair, const std::vector<std::uint32_t>& group,
                      std::vector<std::uint32_t>& clusters) {
  ClusterCut cut;
  cut.cluster.resize(group.size());
  cut.first.push_back(0);
  for (std::size_t cell = 0; cell < pair.cells(); ++cell) {
    const IndexRange under = pair.gaussiansUnder(cell);
    const auto first = static_cast<std::ptrdiff_t>(clusters.size());
    for (std::size_t i = under.first; i < under.last; ++i) {
      const auto known = std::find(clusters.begin() + first, clusters.end(), group[i]);
      cut.cluster[i] = static_cast<std::uint32_t>(known - clusters.begin());
      if (known == clusters.end()) clusters.push_back(group[i]);
    }
    cut.first.push_back(static_cast<std::uint32_t>(clusters.size()));
  }
  return cut;
}

}  // namespace

template <int D>
ReclusterResult<D> recluster(
    const ReclusterInput<D>& from,
    const std::function<ClusterCut(const MapScale<D>&, const std::vector<double>& areas)>& cutOf) {
  ReclusterResult<D> result{coarsen(from.finer, from.grid, from.scale - 1), {}, {}};
  MapScale<D>& coarse = result.scale;
  const ScalePair<D> pair{from.finer, coarse, from.grid, from.scale - 1};
  // Until the clusters are final, `coarse.parent` holds the old cluster of each new cluster.
  setClusters(pair, cutByGroup(pair, from.group, coarse.parent), from.threads);
  result.areas = coarserAreas(from.finer, from.areas, coarse.gaussians.size());
  const ClusterCut cut = cutOf(coarse, result.areas);
  mergeClusters<D>(coarse, &from.finer, from.grid, from.scale, cut);
  matchClusters<D>(from.finer, coarse, from.grid, from.scale);
  result.areas = mergedAreas(result.areas, cut);
  result.group = std::exchange(coarse.parent, {});
  return result;
}

#define GAUSSMAP_INSTANTIATE(D)             \
  template ReclusterResult<D> recluster<D>( \
      const ReclusterInput<D>&, const std::function<ClusterCut(const MapScale<D>&, const std::vector<double>&)>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
