// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "gaussmap/clustering/kl_kmeans.h"
#include "map/near_cells.h"
#include "mapping/online/online_state.h"

namespace gaussmap::detail {
namespace {

/// The finest cells below 0, and those of the same objects: beside one, and seen only while it was.
template <int D>
std::vector<std::uint32_t> cellsToForget(const OnlineCells<D>& cells, const OnlineScan<D>& scan,
                                         const OnlineOptions& options) {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t i : scan.missed)
    if (cells.cell(i, 0).clusters[0].log_odds < 0.0f) found.push_back(i);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  if (found.empty()) return found;

  const Grid<D>& grid = cells.grid();
  const std::int32_t link = cellsFor(options.link, grid.side(0));
  std::vector<bool> taken(cells.slots(0));
  std::vector<std::uint32_t> seeds = found;
  for (const std::uint32_t i : found) taken[i] = true;
  for (std::size_t next = 0; next < found.size(); ++next) {
    const std::uint32_t seed = seeds[next];
    const OnlineCell<D>& from = cells.cell(seed, 0);
    const Evidence& object = from.clusters[0].evidence;
    forNearKeys(cells.cell(found[next], 0).key, 1, link, [&](const CellKey<D>& key) {
      const std::uint32_t near = cells.find(key, 0);
      if (near == OnlineCells<D>::kNone) return;
      const OnlineCell<D>& cell = cells.cell(near, 0);
      const Evidence& evidence = cell.clusters[0].evidence;
      if (taken[near] || evidence.hits == 0 || evidence.first_hit < object.first_hit ||
          evidence.last_hit > object.last_hit)
        return;
      Vector<D> apart = cell.clusters[0].gaussian.mean - from.clusters[0].gaussian.mean;
      for (int axis = 0; axis < D; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        apart[axis] += (double(cell.key[a]) - double(from.key[a])) * grid.side(0);
      }
      if (apart.norm() > options.reach) return;
      taken[near] = true;
      found.push_back(near);
      seeds.push_back(seed);
    });
  }
  return found;
}

/// Clusters that learn by themselves are adjusted to the finer ones that are left.
template <int D>
void readjust(OnlineCells<D>& cells, std::uint32_t i, int scale) {
  std::vector<Gaussian<D>> references;
  for (const OnlineCluster<D>& cluster : cells.cell(i, scale).clusters) references.push_back(cluster.gaussian);
  const KLClustering<D> adjusted = KLKMeans<D>().run(cells.dataUnder(i, scale), references);
  recluster(cells, i, scale, adjusted.references, adjusted.labels);
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
  if (options.learning_rate == LearningRate::SampleMean) return all;  // clusters are sums of what is left
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
