// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/cluster_cuts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "clustering/undo_merges.h"
#include "core/parallel.h"
#include "map/coarsen.h"
#include "map/inherit_occupancy.h"
#include "mapping/blur.h"

namespace gaussmap::detail {
namespace {

/// The parent that most of the weight of some Gaussians belongs to; of several the first.
template <int D>
std::uint32_t heaviestParent(const MapScale<D>& scale, const Grid<D>& grid, int s,
                             const std::vector<std::uint32_t>& members) {
  const std::uint32_t first = scale.parent[members.front()];
  if (std::all_of(members.begin(), members.end(), [&](std::uint32_t i) { return scale.parent[i] == first; }))
    return first;
  std::map<std::uint32_t, double> weights;
  for (const std::uint32_t i : members) weights[scale.parent[i]] += localGaussian(scale, grid, s, i).weight;
  return std::max_element(weights.begin(), weights.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// Members of every cluster, in their order.
std::vector<std::vector<std::uint32_t>> membersOf(const std::vector<std::uint32_t>& cluster, std::size_t clusters) {
  std::vector<std::vector<std::uint32_t>> members(clusters);
  for (std::size_t i = 0; i < cluster.size(); ++i) members[cluster[i]].push_back(static_cast<std::uint32_t>(i));
  return members;
}

/// first_gaussian of a scale whose Gaussian i became number place[i]; nothing where every cell holds one.
template <int D>
std::vector<std::uint32_t> startsAfter(const MapScale<D>& scale, const std::vector<std::uint32_t>& place,
                                       std::size_t count) {
  std::vector<std::uint32_t> starts;
  if (count == scale.keys.size()) return starts;
  for (std::size_t cell = 0; cell < scale.keys.size(); ++cell) starts.push_back(place[gaussiansOf(scale, cell).first]);
  starts.push_back(static_cast<std::uint32_t>(count));
  return starts;
}

}  // namespace

template <int D>
ClusterCuts<D>::ClusterCuts(const MapScale<D>& scale, const Grid<D>& grid, int s, const std::vector<double>& areas,
                            MergeCost cost, int threads)
    : scale_(scale), threads_(threads), dendrograms_(scale.keys.size()) {
  AgglomerateOptions options;
  options.cost = cost;
  parallelFor(dendrograms_.size(), threads, 16, [&](std::size_t cell) {
    const IndexRange range = gaussiansOf(scale, cell);
    dendrograms_[cell].size = range.size();
    if (range.size() < 2) return;
    std::vector<Gaussian<D>> data;
    for (std::size_t i = range.first; i < range.last; ++i) data.push_back(localGaussian(scale, grid, s, i));
    blurForClustering(data, grid.side(0));
    const auto first = areas.begin() + static_cast<std::ptrdiff_t>(range.first);
    dendrograms_[cell] = agglomerate<D>(data, {first, first + static_cast<std::ptrdiff_t>(range.size())}, options);
  });
}

template <int D>
ClusterCut ClusterCuts<D>::withExtra(std::size_t extra, const std::vector<char>& keep) const {
  std::vector<std::vector<double>> gains(cells());
  parallelFor(cells(), threads_, 256, [&](std::size_t cell) {
    if (keep.empty() || !keep[cell]) gains[cell] = gainsOfUndoing(dendrograms_[cell]);
  });
  std::vector<std::size_t> parts = partsPerCell(gains, extra);
  for (std::size_t cell = 0; cell < keep.size(); ++cell)
    if (keep[cell]) parts[cell] = gaussiansOf(scale_, cell).size();
  ClusterCut cut;
  cut.cluster.reserve(scale_.gaussianCount());
  for (std::size_t cell = 0; cell < cells(); ++cell) {
    for (const int label : labels(dendrograms_[cell], parts[cell]))
      cut.cluster.push_back(static_cast<std::uint32_t>(cut.clusters) + static_cast<std::uint32_t>(label));
    cut.clusters += parts[cell];
  }
  return cut;
}

template <int D>
void mergeClusters(MapScale<D>& scale, MapScale<D>* finer, const Grid<D>& grid, int s, const ClusterCut& cut) {
  if (cut.clusters == scale.gaussianCount()) return;
  std::vector<Gaussian<D>> gaussians, parts;
  std::vector<std::uint32_t> parent;
  std::vector<float> log_odds;
  for (const std::vector<std::uint32_t>& members : membersOf(cut.cluster, cut.clusters)) {
    parts.clear();
    for (const std::uint32_t i : members) parts.push_back(localGaussian(scale, grid, s, i));
    gaussians.push_back(merge(parts));
    if (!scale.parent.empty()) parent.push_back(heaviestParent(scale, grid, s, members));
    if (scale.log_odds.empty()) continue;
    float highest = scale.log_odds[members.front()];
    for (const std::uint32_t i : members) highest = std::max(highest, scale.log_odds[i]);
    log_odds.push_back(highest);
  }
  scale.first_gaussian = startsAfter(scale, cut.cluster, cut.clusters);
  scale.gaussians = std::move(gaussians);
  scale.parent = std::move(parent);
  scale.log_odds = std::move(log_odds);
  if (finer != nullptr)
    for (std::uint32_t& link : finer->parent) link = cut.cluster[link];
}

template <int D>
void matchClusters(MapScale<D>& finer, MapScale<D>& scale, const Grid<D>& grid, int s) {
  const std::size_t old_count = scale.gaussianCount();
  std::vector<std::uint32_t> place(old_count);
  std::vector<Gaussian<D>> gaussians, data;
  std::vector<std::vector<Gaussian<D>>> members;
  std::vector<std::uint32_t> stays;  // the clusters that do, by their old numbers
  for (std::size_t cell = 0; cell < scale.keys.size(); ++cell) {
    const IndexRange clusters = gaussiansOf(scale, cell);
    const IndexRange cells{scale.first_child[cell], scale.first_child[cell + 1]};
    members.assign(clusters.size(), {});
    gatherUnder(finer, grid, s - 1, cells, data);
    const std::size_t first = cells.empty() ? 0 : gaussiansOf(finer, cells.first).first;
    for (std::size_t j = 0; j < data.size(); ++j) members[finer.parent[first + j] - clusters.first].push_back(data[j]);
    for (std::size_t i = clusters.first; i < clusters.last; ++i) {
      const std::vector<Gaussian<D>>& own = members[i - clusters.first];
      place[i] = static_cast<std::uint32_t>(gaussians.size());
      if (own.empty() && !cells.empty()) continue;
      gaussians.push_back(own.empty() ? scale.gaussians[i] : merge(own));
      stays.push_back(static_cast<std::uint32_t>(i));
    }
  }
  scale.first_gaussian = startsAfter(scale, place, gaussians.size());
  scale.gaussians = std::move(gaussians);
  if (stays.size() < old_count) {
    for (std::size_t i = 0; i < stays.size(); ++i) {
      if (!scale.parent.empty()) scale.parent[i] = scale.parent[stays[i]];
      if (!scale.log_odds.empty()) scale.log_odds[i] = scale.log_odds[stays[i]];
    }
    if (!scale.parent.empty()) scale.parent.resize(stays.size());
    if (!scale.log_odds.empty()) scale.log_odds.resize(stays.size());
    for (std::uint32_t& link : finer.parent) link = place[link];
  }
  inheritOccupancy<D>(finer, scale);
}

#define GAUSSMAP_INSTANTIATE(D)                                                                       \
  template class ClusterCuts<D>;                                                                      \
  template void mergeClusters<D>(MapScale<D>&, MapScale<D>*, const Grid<D>&, int, const ClusterCut&); \
  template void matchClusters<D>(MapScale<D>&, MapScale<D>&, const Grid<D>&, int);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
