// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "clustering/merge_gains.h"
#include "core/parallel.h"
#include "gaussmap/clustering/kl_kmeans.h"
#include "mapping/cell_error.h"
#include "mapping/clustering_noise.h"
#include "mapping/online/online_state.h"

namespace gaussmap::detail {
namespace {

/// A coarse cell with points of the scan.
struct Touched {
  std::uint32_t cell = 0;
  double error = 0.0;  // Yguel 2009 eq. (6)
  Dendrogram dendrogram;
};

template <int D>
std::vector<Gaussian<D>> centresOf(const OnlineCell<D>& cell) {
  std::vector<Gaussian<D>> centres;
  for (const OnlineCluster<D>& cluster : cell.clusters) centres.push_back(cluster.gaussian);
  return centres;
}

/// Returns true if the mean probability of occupancy of the finer clusters under the cell is above one half.
template <int D>
bool isOccupied(OnlineCells<D>& cells, std::uint32_t i, int scale) {
  double sum = 0.0, count = 0.0;
  cells.forClustersUnder(i, scale, [&](const OnlineCluster<D>& finer) {
    sum += 1.0 / (1.0 + std::exp(-double(finer.log_odds)));
    count += 1.0;
  });
  return sum > 0.5 * count;
}

/// Returns the factors of the finer clusters under the cell in eq. (6), or an empty vector if all are 1.
template <int D>
std::vector<double> errorFactors(OnlineCells<D>& cells, std::uint32_t i, int scale, const OnlineOptions& options) {
  std::vector<double> factors;
  if (options.error_factor == ErrorFactor::One || options.learning_rate == LearningRate::SampleMean) return factors;
  cells.forClustersUnder(i, scale, [&](const OnlineCluster<D>& finer) {
    factors.push_back(1.0 - rateOf(double(finer.log_odds), options));
  });
  return factors;
}

template <int D>
Dendrogram dendrogramOf(OnlineCells<D>& cells, std::uint32_t i, int scale, std::vector<Gaussian<D>> data) {
  std::vector<double> areas;
  cells.forClustersUnder(i, scale, [&](const OnlineCluster<D>& finer) { areas.push_back(std::max(1.0, finer.area)); });
  addClusteringNoise(data, cells.grid().side(0));
  return agglomerate(data, areas);
}

/// Sets `need` and `spare` of a cell: the gain of one more cluster, and the gain of its last cluster.
template <int D>
void noteGains(OnlineCell<D>& cell, const Dendrogram& dendrogram) {
  const std::vector<double> gains = mergeGains(dendrogram);
  const std::size_t parts = cell.clusters.size();
  cell.need = parts - 1 < gains.size() ? gains[parts - 1] : 0.0;
  cell.spare = parts >= 2 && parts - 2 < gains.size() ? gains[parts - 2] : 0.0;
}

/// Returns the coarse cells with points of the scan, with their errors, and sets their `need` and `spare`.
template <int D>
std::vector<Touched> lookAtTouched(OnlineCells<D>& cells, const OnlineScan<D>& scan, int scale,
                                   const OnlineOptions& options) {
  std::vector<std::uint32_t> touched;
  for (std::uint32_t i : scan.touched) {
    if (!cells.cell(i, 0).alive) continue;  // deleted by forget()
    for (int s = 0; s < scale; ++s) i = cells.cell(i, s).parent;
    touched.push_back(i);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  if (options.learning_rate == LearningRate::SampleMean)
    for (const std::uint32_t i : touched) cells.refresh(i, scale);

  std::vector<Touched> all(touched.size());
  parallelFor(touched.size(), options.threads, 16, [&](std::size_t n) {
    all[n].cell = touched[n];
    OnlineCell<D>& cell = cells.cell(touched[n], scale);
    const std::vector<Gaussian<D>> data = cells.dataUnder(touched[n], scale);
    all[n].error = cellError(centresOf(cell), data, errorFactors(cells, touched[n], scale, options));
    cell.need = cell.spare = 0.0;
    if (data.size() < 2 || !isOccupied(cells, touched[n], scale)) return;
    if (options.method == RefineMethod::Insert) {
      cell.need = data.size() > cell.clusters.size() ? all[n].error : 0.0;
    } else {
      all[n].dendrogram = dendrogramOf(cells, touched[n], scale, data);
      noteGains(cell, all[n].dendrogram);
    }
  });
  return all;
}

template <int D>
void setParts(OnlineCells<D>& cells, std::uint32_t i, int scale, const Dendrogram& dendrogram, std::size_t parts) {
  const std::vector<int> of = labels(dendrogram, parts);
  const std::vector<Gaussian<D>> data = cells.dataUnder(i, scale);
  std::vector<std::vector<Gaussian<D>>> members(parts);
  for (std::size_t j = 0; j < data.size(); ++j) members[static_cast<std::size_t>(of[j])].push_back(data[j]);
  std::vector<Gaussian<D>> centres;
  centres.reserve(parts);
  for (const std::vector<Gaussian<D>>& part : members) centres.push_back(merge(part));
  recluster(cells, i, scale, centres, of);
}

/// A value and its cell (negative slot). Of equal values, the smaller slot is first.
using Entry = std::pair<double, std::int64_t>;

/// Returns the cells of a scale with a positive `value`; the largest (sign = 1) or smallest (sign = -1) is on top.
template <int D>
std::priority_queue<Entry> queueOf(const OnlineCells<D>& cells, int scale, double OnlineCell<D>::*value, double sign) {
  std::vector<Entry> entries;
  for (std::uint32_t i = 0; i < cells.slots(scale); ++i)
    if (cells.cell(i, scale).alive && cells.cell(i, scale).*value > 0.0)
      entries.emplace_back(sign * (cells.cell(i, scale).*value), -std::int64_t{i});
  return std::priority_queue<Entry>(std::less<Entry>(), std::move(entries));
}

/// Returns the cells that can get clusters and have a positive need; the largest is on top.
template <int D>
std::priority_queue<Entry> needyCells(const OnlineCells<D>& cells, int scale, const std::vector<Touched>& touched,
                                      const OnlineOptions& options) {
  if (options.refine_area == RefineArea::Known) return queueOf(cells, scale, &OnlineCell<D>::need, 1.0);
  std::vector<Entry> entries;
  for (const Touched& one : touched)
    if (const double need = cells.cell(one.cell, scale).need; need > 0.0)
      entries.emplace_back(need, -std::int64_t{one.cell});
  return std::priority_queue<Entry>(std::less<Entry>(), std::move(entries));
}

/// Agglomerates the finer clusters under a cell into at most `parts` clusters.
template <int D>
void cutInto(std::size_t parts, OnlineCells<D>& cells, std::uint32_t i, int scale) {
  const Dendrogram dendrogram = dendrogramOf(cells, i, scale, cells.dataUnder(i, scale));
  setParts(cells, i, scale, dendrogram, std::min(parts, dendrogram.size));
  noteGains(cells.cell(i, scale), dendrogram);
}

/// Removes one cluster from the cell where it gains least. Returns this cell.
template <int D>
std::uint32_t takeOne(OnlineCells<D>& cells, int scale, std::priority_queue<Entry>& rich) {
  const auto from = static_cast<std::uint32_t>(-rich.top().second);
  rich.pop();
  cutInto(cells.cell(from, scale).clusters.size() - 1, cells, from, scale);
  if (cells.cell(from, scale).spare > 0.0) rich.emplace(-cells.cell(from, scale).spare, -std::int64_t{from});
  return from;
}

template <int D>
void insertOne(OnlineCells<D>& cells, std::uint32_t i, int scale, ClusterSeed seed_rule) {
  KLKMeansOptions options;
  options.seed_rule = seed_rule;
  const KLClustering<D> found = insertCluster(cells.dataUnder(i, scale), centresOf(cells.cell(i, scale)), options);
  recluster(cells, i, scale, found.centres, found.labels);
  cells.cell(i, scale).need = 0.0;  // until the next refinement that touches the cell
}

}  // namespace

template <int D>
void recluster(OnlineCells<D>& cells, std::uint32_t i, int scale, const std::vector<Gaussian<D>>& centres,
               const std::vector<int>& labels) {
  const OnlineClusters<D>& old = cells.cell(i, scale).clusters;
  std::vector<std::vector<double>> shared(centres.size(), std::vector<double>(old.size(), 0.0));
  std::vector<double> areas(centres.size(), 0.0);
  std::size_t next = 0;
  cells.forClustersUnder(i, scale, [&](OnlineCluster<D>& finer) {
    const auto part = static_cast<std::uint32_t>(labels[next++]);
    shared[part][finer.parent] += finer.gaussian.weight;
    areas[part] += finer.area;
    finer.parent = part;
  });
  OnlineClusters<D> clusters;
  for (std::size_t part = 0; part < centres.size(); ++part) {
    const auto most = std::max_element(shared[part].begin(), shared[part].end());
    clusters.push_back(old[static_cast<std::size_t>(most - shared[part].begin())]);
    clusters.back().gaussian = centres[part];
    clusters.back().area = areas[part];
  }
  cells.setClusters(i, scale, std::move(clusters));
  if (scale + 1 < cells.scales()) cells.markStale(cells.cell(i, scale).parent, scale + 1);
}

template <int D>
void refineVisible(OnlineCells<D>& cells, const OnlineScan<D>& scan, const OnlineOptions& options,
                   OnlineStatistics& statistics) {
  statistics.errors.assign(static_cast<std::size_t>(cells.scales()), 0.0);
  for (int scale = 1; scale < cells.scales(); ++scale) {
    const std::vector<Touched> all = lookAtTouched(cells, scan, scale, options);
    double error = 0.0;
    for (const Touched& touched : all) error += touched.error;
    statistics.errors[static_cast<std::size_t>(scale)] = all.empty() ? 0.0 : error / double(all.size());
    // New finer clusters were linked to the nearest coarse clusters. Now a different partition can be better.
    for (const Touched& touched : all) {
      const std::size_t parts = cells.cell(touched.cell, scale).clusters.size();
      if (parts > 1 && touched.dendrogram.size >= parts)
        setParts(cells, touched.cell, scale, touched.dendrogram, parts);
    }

    std::priority_queue<Entry> needy = needyCells(cells, scale, all, options), rich;
    const double most = std::floor(options.budget * double(cells.size(scale)));
    if (options.method == RefineMethod::Agglomerate && double(cells.clusterCount(scale)) > most) {
      // Cells were deleted, so the budget is smaller now.
      rich = queueOf(cells, scale, &OnlineCell<D>::spare, -1.0);
      while (!rich.empty() && double(cells.clusterCount(scale)) > most) takeOne(cells, scale, rich);
    }
    const std::size_t limit = options.refine_cells > 0 ? options.refine_cells : cells.size(scale - 1);
    std::size_t given = 0;
    for (; given < limit && !needy.empty(); ++given) {
      const auto next = static_cast<std::uint32_t>(-needy.top().second);
      const double need = needy.top().first;
      if (double(cells.clusterCount(scale)) + 1.0 > most) {
        // The budget is used up: a cluster moves here only if it gains more here than in the cell that loses it.
        if (options.method == RefineMethod::Insert) break;
        if (rich.empty()) rich = queueOf(cells, scale, &OnlineCell<D>::spare, -1.0);
        if (rich.empty() || !(need > -rich.top().first)) break;
        if (takeOne(cells, scale, rich) == next) break;  // nothing left to gain
      }
      needy.pop();
      if (options.method == RefineMethod::Insert) {
        insertOne(cells, next, scale, options.seed_rule);
        continue;
      }
      cutInto(cells.cell(next, scale).clusters.size() + 1, cells, next, scale);
      if (cells.cell(next, scale).need > 0.0) needy.emplace(cells.cell(next, scale).need, -std::int64_t{next});
    }
    statistics.added += given;
  }
}

#define GAUSSMAP_INSTANTIATE(D)                                                                      \
  template void recluster<D>(OnlineCells<D>&, std::uint32_t, int, const std::vector<Gaussian<(D)>>&, \
                             const std::vector<int>&);                                               \
  template void refineVisible<D>(OnlineCells<D>&, const OnlineScan<D>&, const OnlineOptions&, OnlineStatistics&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
