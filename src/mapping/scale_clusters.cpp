// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/scale_clusters.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "clustering/merge_gains.h"
#include "core/parallel.h"
#include "gaussmap/clustering/kl_kmeans.h"
#include "map/inherit_occupancy.h"
#include "mapping/clustering_noise.h"

namespace gaussmap::detail {
namespace {

std::vector<double>::const_iterator areaOf(const std::vector<double>& areas, std::size_t index) {
  return areas.begin() + static_cast<std::ptrdiff_t>(index);
}

/// Returns MapScale::first_gaussian, which is empty if every cell holds one Gaussian.
std::vector<std::uint32_t> startsOf(std::vector<std::uint32_t> first) {
  if (first.back() + std::size_t{1} == first.size()) first.clear();
  return first;
}

/// Returns the parent with the largest part of the weight of some Gaussians; if several are equal, the first.
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

/// Returns the members of every cluster, by increasing index.
std::vector<std::vector<std::uint32_t>> membersOf(const ClusterCut& cut) {
  std::vector<std::vector<std::uint32_t>> members(cut.clusters());
  for (std::size_t i = 0; i < cut.cluster.size(); ++i) members[cut.cluster[i]].push_back(static_cast<std::uint32_t>(i));
  return members;
}

/// Agglomerates the Gaussians of a cell. `first` = area of the first Gaussian.
template <int D>
Dendrogram dendrogramOf(std::vector<Gaussian<D>> data, std::vector<double>::const_iterator first, const Grid<D>& grid,
                        MergeCost cost) {
  std::vector<double> areas(first, first + static_cast<std::ptrdiff_t>(data.size()));
  return agglomerateCell<D>(std::move(data), areas, grid.side(0), cost);
}

}  // namespace

/// No local search follows, because it gains little. The search that was tried moves single Gaussians to other clusters
/// and exchanges merges for splits in other cells until nothing improves. It lowers the mean error of the coarsest
/// scale by 4 % (street), 2 % (outdoor lidar) and less (office, building). The clusters of different budgets would then
/// no longer be nested.
template <int D>
Dendrogram agglomerateCell(std::vector<Gaussian<D>> data, const std::vector<double>& areas, double finest_side,
                           MergeCost cost) {
  if (data.size() < 2) return {data.size(), {}};
  if (cost != MergeCost::KL) addClusteringNoise(data, finest_side);
  AgglomerateOptions options;
  options.cost = cost;
  return agglomerate<D>(data, areas, options);
}

template <int D>
ScaleClusters ScaleClusters::under(const ScalePair<D>& pair, const std::vector<double>& areas, MergeCost cost,
                                   int threads) {
  ScaleClusters clusters(pair.cells(), threads);
  parallelFor(pair.cells(), threads, 4, [&](std::size_t cell) {
    const IndexRange under = pair.gaussiansUnder(cell);
    clusters.dendrograms_[cell].size = under.size();
    if (under.size() < 2) return;
    clusters.dendrograms_[cell] = dendrogramOf<D>(pair.dataUnder(cell), areaOf(areas, under.first), pair.grid, cost);
    clusters.gains_[cell] = mergeGains(clusters.dendrograms_[cell]);
  });
  return clusters;
}

template <int D>
ScaleClusters ScaleClusters::within(const MapScale<D>& scale, const Grid<D>& grid, int s,
                                    const std::vector<double>& areas, MergeCost cost, int threads,
                                    const std::vector<char>& keep) {
  ScaleClusters clusters(scale.keys.size(), threads);
  parallelFor(scale.keys.size(), threads, 16, [&](std::size_t cell) {
    const IndexRange range = gaussiansOf(scale, cell);
    clusters.dendrograms_[cell].size = range.size();
    if (range.size() < 2 || (!keep.empty() && keep[cell])) return;
    std::vector<Gaussian<D>> data;
    for (std::size_t i = range.first; i < range.last; ++i) data.push_back(localGaussian(scale, grid, s, i));
    clusters.dendrograms_[cell] = dendrogramOf<D>(std::move(data), areaOf(areas, range.first), grid, cost);
    clusters.gains_[cell] = mergeGains(clusters.dendrograms_[cell]);
  });
  return clusters;
}

ScaleClusters::ScaleClusters(std::vector<Dendrogram> dendrograms, int threads)
    : dendrograms_(std::move(dendrograms)), gains_(dendrograms_.size()), threads_(threads) {
  for (std::size_t cell = 0; cell < gains_.size(); ++cell) gains_[cell] = mergeGains(dendrograms_[cell]);
}

std::size_t ScaleClusters::maxExtra() const {
  std::size_t most = 0;
  for (const Dendrogram& dendrogram : dendrograms_) most += dendrogram.merges.size();
  return most;
}

ClusterCut ScaleClusters::cut(std::size_t extra) const {
  return cut(partsPerCell(gains_, extra));
}

ClusterCut ScaleClusters::cut(const std::vector<std::size_t>& parts) const {
  ClusterCut cut;
  cut.first.reserve(dendrograms_.size() + 1);
  cut.first.push_back(0);
  std::vector<std::size_t> first_datum = {0};
  first_datum.reserve(dendrograms_.size() + 1);
  for (std::size_t cell = 0; cell < dendrograms_.size(); ++cell) {
    const Dendrogram& dendrogram = dendrograms_[cell];
    const std::size_t count = dendrogram.merges.empty() ? dendrogram.size : parts[cell];
    cut.first.push_back(cut.first.back() + static_cast<std::uint32_t>(count));
    first_datum.push_back(first_datum.back() + dendrogram.size);
  }
  cut.cluster.resize(first_datum.back());
  parallelFor(dendrograms_.size(), threads_, 64, [&](std::size_t cell) {
    const auto begin = cut.cluster.begin() + static_cast<std::ptrdiff_t>(first_datum[cell]);
    const auto end = begin + static_cast<std::ptrdiff_t>(dendrograms_[cell].size);
    const std::uint32_t first = cut.first[cell];
    if (dendrograms_[cell].merges.empty()) {
      std::iota(begin, end, first);
    } else if (parts[cell] == 1) {
      std::fill(begin, end, first);
    } else {
      const std::vector<int> of = labels(dendrograms_[cell], parts[cell]);
      std::transform(of.begin(), of.end(), begin, [&](int label) { return first + static_cast<std::uint32_t>(label); });
    }
  });
  return cut;
}

template <int D>
ClusterCut onePerCell(const MapScale<D>& scale) {
  ClusterCut cut;
  cut.first.resize(scale.keys.size() + 1);
  std::iota(cut.first.begin(), cut.first.end(), 0u);
  cut.cluster.reserve(scale.gaussianCount());
  for (std::size_t cell = 0; cell < scale.keys.size(); ++cell)
    cut.cluster.insert(cut.cluster.end(), gaussiansOf(scale, cell).size(), static_cast<std::uint32_t>(cell));
  return cut;
}

template <int D>
ClusterCut smoothed(const MapScale<D>& scale, const Grid<D>& grid, int s, const ClusterCut& cut, int threads) {
  const std::size_t cells = scale.keys.size();
  std::vector<std::vector<int>> label(cells);  // empty: the cell keeps the clusters of `cut`
  parallelFor(cells, threads, 4, [&](std::size_t cell) {
    const IndexRange range = gaussiansOf(scale, cell);
    const std::size_t parts = cut.first[cell + 1] - cut.first[cell];
    if (parts == 1 || parts == range.size()) return;
    std::vector<Gaussian<D>> data;
    for (std::size_t i = range.first; i < range.last; ++i) data.push_back(localGaussian(scale, grid, s, i));
    for (std::size_t j = 0; j < data.size(); ++j)
      label[cell].push_back(static_cast<int>(cut.cluster[range.first + j] - cut.first[cell]));
    label[cell] = smoothedLabels<D>(data, label[cell], parts);
  });
  ClusterCut result;
  result.first.push_back(0);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::uint32_t first = result.first.back();
    std::uint32_t parts = cut.first[cell + 1] - cut.first[cell];
    if (label[cell].empty()) {
      const IndexRange range = gaussiansOf(scale, cell);
      for (std::size_t i = range.first; i < range.last; ++i)
        result.cluster.push_back(first + cut.cluster[i] - cut.first[cell]);
    } else {
      for (const int one : label[cell]) result.cluster.push_back(first + static_cast<std::uint32_t>(one));
      parts = 1 + static_cast<std::uint32_t>(*std::max_element(label[cell].begin(), label[cell].end()));
    }
    result.first.push_back(first + parts);
  }
  return result;
}

template <int D>
std::vector<Gaussian<D>> clustersOf(const std::vector<Gaussian<D>>& data, const std::vector<int>& label,
                                    std::size_t parts) {
  std::vector<std::vector<Gaussian<D>>> members(parts);
  for (std::size_t i = 0; i < data.size(); ++i) members[static_cast<std::size_t>(label[i])].push_back(data[i]);
  std::vector<Gaussian<D>> clusters;
  clusters.reserve(parts);
  for (const std::vector<Gaussian<D>>& part : members) clusters.push_back(merge(part));
  return clusters;
}

template <int D>
std::vector<int> smoothedLabels(const std::vector<Gaussian<D>>& data, const std::vector<int>& label,
                                std::size_t parts) {
  return KLKMeans<D>().run(data, clustersOf<D>(data, label, parts)).labels;
}

std::vector<double> mergedAreas(const std::vector<double>& areas, const ClusterCut& cut) {
  std::vector<double> merged(cut.clusters(), 0.0);
  for (std::size_t i = 0; i < areas.size(); ++i) merged[cut.cluster[i]] += areas[i];
  return merged;
}

template <int D>
std::vector<Gaussian<D>> clusterGaussians(const ScalePair<D>& pair, const ClusterCut& cut, int threads) {
  std::vector<Gaussian<D>> gaussians(cut.clusters());
  parallelFor(pair.cells(), threads, 16, [&](std::size_t cell) {
    const std::size_t first = cut.first[cell], parts = cut.first[cell + 1] - first;
    if (parts == 1) {
      gaussians[first] = pair.coarse.gaussians[cell];
      return;
    }
    const std::vector<Gaussian<D>> data = pair.dataUnder(cell);
    const std::size_t first_datum = pair.gaussiansUnder(cell).first;
    std::vector<std::vector<Gaussian<D>>> members(parts);
    for (std::size_t j = 0; j < data.size(); ++j) members[cut.cluster[first_datum + j] - first].push_back(data[j]);
    for (std::size_t part = 0; part < parts; ++part) gaussians[first + part] = merge(members[part]);
  });
  return gaussians;
}

template <int D>
void setClusters(const ScalePair<D>& pair, ClusterCut cut, int threads) {
  pair.coarse.gaussians = clusterGaussians(pair, cut, threads);
  pair.coarse.first_gaussian = startsOf(std::move(cut.first));
  pair.finer.parent = std::move(cut.cluster);
}

template <int D>
void mergeClusters(MapScale<D>& scale, MapScale<D>* finer, const Grid<D>& grid, int s, const ClusterCut& cut) {
  if (cut.clusters() == scale.gaussianCount()) return;
  std::vector<Gaussian<D>> gaussians, parts;
  std::vector<std::uint32_t> parent;
  std::vector<float> log_odds;
  for (const std::vector<std::uint32_t>& members : membersOf(cut)) {
    parts.clear();
    for (const std::uint32_t i : members) parts.push_back(localGaussian(scale, grid, s, i));
    gaussians.push_back(merge(parts));
    if (!scale.parent.empty()) parent.push_back(heaviestParent(scale, grid, s, members));
    if (scale.log_odds.empty()) continue;
    float highest = scale.log_odds[members.front()];
    for (const std::uint32_t i : members) highest = std::max(highest, scale.log_odds[i]);
    log_odds.push_back(highest);
  }
  scale.first_gaussian = startsOf(cut.first);
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
  std::vector<std::uint32_t> stays;  // old indices of the clusters that are kept
  std::vector<std::uint32_t> first;  // first cluster per cell, then the number of clusters
  first.reserve(scale.keys.size() + 1);
  for (std::size_t cell = 0; cell < scale.keys.size(); ++cell) {
    first.push_back(static_cast<std::uint32_t>(gaussians.size()));
    const IndexRange clusters = gaussiansOf(scale, cell);
    const IndexRange cells{scale.first_child[cell], scale.first_child[cell + 1]};
    members.assign(clusters.size(), {});
    gatherUnder(finer, grid, s - 1, cells, data);
    const std::size_t first_datum = cells.empty() ? 0 : gaussiansOf(finer, cells.first).first;
    for (std::size_t j = 0; j < data.size(); ++j)
      members[finer.parent[first_datum + j] - clusters.first].push_back(data[j]);
    for (std::size_t i = clusters.first; i < clusters.last; ++i) {
      const std::vector<Gaussian<D>>& own = members[i - clusters.first];
      place[i] = static_cast<std::uint32_t>(gaussians.size());
      if (own.empty() && !cells.empty()) continue;
      gaussians.push_back(own.empty() ? scale.gaussians[i] : merge(own));
      stays.push_back(static_cast<std::uint32_t>(i));
    }
  }
  first.push_back(static_cast<std::uint32_t>(gaussians.size()));
  scale.first_gaussian = startsOf(std::move(first));
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

#define GAUSSMAP_INSTANTIATE(D)                                                                                        \
  template ScaleClusters ScaleClusters::under<D>(const ScalePair<D>&, const std::vector<double>&, MergeCost, int);     \
  template ScaleClusters ScaleClusters::within<D>(const MapScale<D>&, const Grid<D>&, int, const std::vector<double>&, \
                                                  MergeCost, int, const std::vector<char>&);                           \
  template Dendrogram agglomerateCell<D>(std::vector<Gaussian<(D)>>, const std::vector<double>&, double, MergeCost);   \
  template std::vector<Gaussian<(D)>> clustersOf<D>(const std::vector<Gaussian<(D)>>&, const std::vector<int>&,        \
                                                    std::size_t);                                                      \
  template std::vector<int> smoothedLabels<D>(const std::vector<Gaussian<(D)>>&, const std::vector<int>&,              \
                                              std::size_t);                                                            \
  template ClusterCut smoothed<D>(const MapScale<D>&, const Grid<D>&, int, const ClusterCut&, int);                    \
  template ClusterCut onePerCell<D>(const MapScale<D>&);                                                               \
  template std::vector<Gaussian<(D)>> clusterGaussians<D>(const ScalePair<D>&, const ClusterCut&, int);                \
  template void setClusters<D>(const ScalePair<D>&, ClusterCut, int);                                                  \
  template void mergeClusters<D>(MapScale<D>&, MapScale<D>*, const Grid<D>&, int, const ClusterCut&);                  \
  template void matchClusters<D>(MapScale<D>&, MapScale<D>&, const Grid<D>&, int);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
