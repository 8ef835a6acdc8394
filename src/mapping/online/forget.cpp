// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "gaussmap/clustering/kl_kmeans.h"
#include "mapping/moving/object_rules.h"
#include "mapping/online/online_state.h"

namespace gaussmap::detail {
namespace {

/// Returns the missed finest cells with log-odds below the limit, and the other cells of the same objects.
template <int D>
std::vector<std::uint32_t> cellsToForget(const OnlineCells<D>& cells, const OnlineScan<D>& scan,
                                         const OnlineOptions& options) {
  std::vector<std::uint32_t> freed;
  for (const std::uint32_t i : scan.missed)
    if (cells.cell(i, 0).clusters[0].log_odds < static_cast<float>(options.forget_below)) freed.push_back(i);
  std::sort(freed.begin(), freed.end());
  freed.erase(std::unique(freed.begin(), freed.end()), freed.end());
  return cellsOfObjects(FinestOnlineCells<D>{cells}, std::move(freed), *options.link, *options.reach);
}

/// Fits the clusters of a coarse cell to the finer clusters that remain, by k-means from the current clusters. Used for
/// LearningRate::Occupancy, where coarse clusters learn from the points and not from the finer clusters.
template <int D>
void readjust(OnlineCells<D>& cells, std::uint32_t i, int scale) {
  std::vector<Gaussian<D>> centres;
  for (const OnlineCluster<D>& cluster : cells.cell(i, scale).clusters) centres.push_back(cluster.gaussian);
  const KLClustering<D> adjusted = KLKMeans<D>().run(cells.dataUnder(i, scale), centres);
  recluster(cells, i, scale, adjusted.centres, adjusted.labels);
}

}  // namespace

template <int D>
std::vector<GoneCell<D>> forget(OnlineCells<D>& cells, const OnlineScan<D>& scan, const OnlineOptions& options,
                                const typename OnlineMapper<D>::Removed& removed, OnlineStatistics& statistics) {
  std::vector<GoneCell<D>> all;
  const auto gone = [&](std::uint32_t i, std::size_t c, int scale) {
    ++statistics.deleted;
    if (!removed) return;
    const OnlineCell<D>& cell = cells.cell(i, scale);
    const OnlineCluster<D>& cluster = cell.clusters[c];
    RemovedCluster<D> entry{scale,      cluster.gaussian, cell.key, {}, double(cluster.log_odds), cluster.evidence,
                            scan.number};
    entry.gaussian.mean += cells.grid().centre(cell.key, scale);
    if (scale == 0) entry.moments = cells.moments(i);
    removed(entry);
  };
  std::vector<std::vector<std::uint32_t>> changed(static_cast<std::size_t>(cells.scales()));
  for (const std::uint32_t cell : cellsToForget(cells, scan, options)) {
    std::uint32_t above = cell;
    for (int scale = 1; scale < cells.scales(); ++scale) {
      above = cells.cell(above, scale - 1).parent;
      changed[static_cast<std::size_t>(scale)].push_back(above);
    }
    const OnlineCluster<D>& cluster = cells.cell(cell, 0).clusters[0];
    all.push_back({cells.cell(cell, 0).key, cluster.evidence, cluster.log_odds});
    cells.erase(cell, gone);
  }
  // The coarse clusters of SampleMean are stale now. They are recomputed from their children later.
  if (options.learning_rate == LearningRate::SampleMean) return all;
  for (int scale = 1; scale < cells.scales(); ++scale) {
    std::vector<std::uint32_t>& list = changed[static_cast<std::size_t>(scale)];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    for (const std::uint32_t i : list)
      if (cells.cell(i, scale).alive) readjust(cells, i, scale);
  }
  return all;
}

template std::vector<GoneCell<2>> forget<2>(OnlineCells<2>&, const OnlineScan<2>&, const OnlineOptions&,
                                            const OnlineMapper<2>::Removed&, OnlineStatistics&);
template std::vector<GoneCell<3>> forget<3>(OnlineCells<3>&, const OnlineScan<3>&, const OnlineOptions&,
                                            const OnlineMapper<3>::Removed&, OnlineStatistics&);

}  // namespace gaussmap::detail
