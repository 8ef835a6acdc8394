// SPDX-License-Identifier: BSD-3-Clause
#include "editing/regroup.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "map/areas.h"
#include "mapping/refine_scale.h"

namespace gaussmap::detail {
namespace {

/// Of each cluster, in their order, the old one that it is a part of.
template <int D>
std::vector<std::uint32_t> clustersByGroup(CoarseScale<D>& scale, const Regrouping<D>& from) {
  std::vector<CellClusters<D>> clusters(scale.cells());
  std::vector<std::vector<std::uint32_t>> groups(scale.cells());
  parallelFor(scale.cells(), from.threads, 16, [&](std::size_t cell) {
    const IndexRange under = scale.gaussiansUnder(cell);
    std::vector<std::uint32_t>& here = groups[cell];
    for (std::size_t i = under.first; i < under.last; ++i) {
      const auto known = std::find(here.begin(), here.end(), from.group[i]);
      clusters[cell].labels.push_back(static_cast<int>(known - here.begin()));
      if (known == here.end()) here.push_back(from.group[i]);
    }
    if (here.size() == 1) return;  // what coarsen() has made
    const std::vector<Gaussian<D>> data = scale.dataUnder(cell);
    std::vector<std::vector<Gaussian<D>>> members(here.size());
    for (std::size_t j = 0; j < data.size(); ++j)
      members[static_cast<std::size_t>(clusters[cell].labels[j])].push_back(data[j]);
    for (const std::vector<Gaussian<D>>& part : members) clusters[cell].references.push_back(merge(part));
  });
  scale.replaceGaussians(clusters);
  std::vector<std::uint32_t> all;
  for (const std::vector<std::uint32_t>& here : groups) all.insert(all.end(), here.begin(), here.end());
  return all;
}

}  // namespace

template <int D>
Regrouped<D> regroup(const Regrouping<D>& from,
                     const std::function<ClusterCut(const MapScale<D>&, const std::vector<double>& areas)>& cutOf) {
  Regrouped<D> result{coarsen(from.finer, from.grid, from.scale - 1), {}, {}};
  MapScale<D>& coarse = result.scale;
  CoarseScale<D> scale{from.finer, coarse, from.grid, from.scale - 1};
  coarse.parent = clustersByGroup(scale, from);  // the old ones for the time being
  result.areas = coarserAreas(from.finer, from.areas, coarse.gaussians.size());
  const ClusterCut cut = cutOf(coarse, result.areas);
  mergeClusters<D>(coarse, &from.finer, from.grid, from.scale, cut);
  matchClusters<D>(from.finer, coarse, from.grid, from.scale);
  result.areas = mergedAreas(result.areas, cut);
  result.group = std::exchange(coarse.parent, {});
  return result;
}

template <int D>
ClusterCut oneACell(const MapScale<D>& scale) {
  ClusterCut cut{{}, scale.keys.size()};
  for (std::size_t cell = 0; cell < cut.clusters; ++cell)
    cut.cluster.insert(cut.cluster.end(), gaussiansOf(scale, cell).size(), static_cast<std::uint32_t>(cell));
  return cut;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                       \
  template Regrouped<D> regroup<D>(const Regrouping<D>&,                                                              \
                                   const std::function<ClusterCut(const MapScale<D>&, const std::vector<double>&)>&); \
  template ClusterCut oneACell<D>(const MapScale<D>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
