// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/refine.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/parallel.h"
#include "gaussmap/clustering/insert_cluster.h"
#include "gaussmap/gaussian/random.h"
#include "gaussmap/mapping/cell_error.h"
#include "gaussmap/mapping/coarsen.h"

namespace gaussmap {
namespace {

void checkOptions(const RefineOptions& options) {
  const auto refuse = [](const std::string& name, double value, const std::string& rule) {
    throw std::invalid_argument(name + " = " + std::to_string(value) + ": must be " + rule);
  };
  if (!(std::isfinite(options.budget) && options.budget >= 1.0))
    refuse("budget", options.budget, "at least 1 Gaussian a cell");
  if (options.queue < 0) refuse("queue", options.queue, "at least 1 (0 = automatic)");
  if (options.max_swaps < 0) refuse("max_swaps", options.max_swaps, "at least 0");
  if (options.threads < 0) refuse("threads", options.threads, "at least 1 (0 = all)");
}

/// The clusters of a refined cell and which of them each finer Gaussian under it belongs to.
template <int D>
struct CellClusters {
  std::vector<Gaussian<D>> references;  // empty: still the one Gaussian of coarsen()
  std::vector<int> labels;
};

struct QueuedCell {
  double error;
  std::size_t cell;
  /// For std::priority_queue: a is served after b. Equal errors: the smaller index first.
  friend bool operator<(const QueuedCell& a, const QueuedCell& b) {
    return a.error != b.error ? a.error < b.error : a.cell > b.cell;
  }
};

/// Refines one coarse scale fresh from coarsen().
template <int D>
class ScaleRefiner {
 public:
  ScaleRefiner(MapScale<D>& finer, MapScale<D>& coarse, const Grid<D>& grid, int finer_scale,
               const RefineOptions& options)
      : finer_(finer),
        coarse_(coarse),
        grid_(grid),
        finer_scale_(finer_scale),
        options_(options),
        cells_(coarse.keys.size()) {}

  void run() {
    const double most = std::floor(options_.budget * static_cast<double>(cells_.size()));
    // More than one per finer Gaussian is never used; the bound also keeps the conversion in range.
    const auto budget = static_cast<std::size_t>(std::min(most, static_cast<double>(finer_.gaussianCount())));
    std::size_t left = budget - std::min(budget, cells_.size());
    if (left == 0) return;
    fillQueue();
    while (left > 0 && !queue_.empty()) left -= refineWorstCells(std::min(left, cellsAtATime()));
    writeBack();
  }

 private:
  struct Insertion {
    std::size_t cell;
    KLClustering<D> clustering;
    double error;
  };

  /// Large rounds keep the threads busy. Outdoor lidar, 6,455 and 43,156 cells, budget 3: up to cells / 250 mean and
  /// largest error stay those of p = 4; at cells / 100 the largest error rises by a third to a half.
  std::size_t cellsAtATime() const {
    if (options_.queue > 0) return static_cast<std::size_t>(options_.queue);
    return std::max<std::size_t>(4, cells_.size() / 250);
  }

  /// A round that is over in about a millisecond is not worth waking other threads: on a busy machine one waits
  /// longer for them than the work takes.
  int threadsForRound() const {
    constexpr std::size_t kSmallRound = 20000;  // distances in one assignment, about 45 ns each for a whole insertion
    std::size_t distances = 0;
    for (const Insertion& insertion : insertions_)
      distances += gaussiansUnder(insertion.cell).size() * (clusterCount(insertion.cell) + 1);
    return distances < kSmallRound ? 1 : options_.threads;
  }

  IndexRange children(std::size_t cell) const { return {coarse_.first_child[cell], coarse_.first_child[cell + 1]}; }
  /// G(phi(c)) as indices of the finer scale.
  IndexRange gaussiansUnder(std::size_t cell) const {
    const IndexRange finer_cells = children(cell);
    return {gaussiansOf(finer_, finer_cells.first).first, gaussiansOf(finer_, finer_cells.last - 1).last};
  }
  std::size_t clusterCount(std::size_t cell) const { return std::max<std::size_t>(1, cells_[cell].references.size()); }

  void enqueue(std::size_t cell, double error) {
    if (error > 0.0 && clusterCount(cell) < gaussiansUnder(cell).size()) queue_.push({error, cell});
  }

  void fillQueue() {
    std::vector<double> errors(cells_.size());
    parallelFor(cells_.size(), options_.threads, 64, [&](std::size_t cell) {
      if (gaussiansUnder(cell).size() < 2) return;
      std::vector<Gaussian<D>> data;
      gatherUnder(finer_, grid_, finer_scale_, children(cell), data);
      errors[cell] = cellError({coarse_.gaussians[cell]}, data);
    });
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) enqueue(cell, errors[cell]);
  }

  /// One round: one more cluster for each of the `count` worst cells. Returns how many were made.
  std::size_t refineWorstCells(std::size_t count) {
    insertions_.clear();
    for (; count > 0 && !queue_.empty(); --count, queue_.pop()) insertions_.push_back({queue_.top().cell, {}, 0.0});
    parallelFor(insertions_.size(), threadsForRound(), 1, [&](std::size_t i) { insert(insertions_[i]); });
    std::size_t made = 0;
    for (Insertion& insertion : insertions_) {
      if (insertion.clustering.references.size() <= clusterCount(insertion.cell)) continue;  // leaves the queue
      ++made;
      cells_[insertion.cell] = {std::move(insertion.clustering.references), std::move(insertion.clustering.labels)};
      enqueue(insertion.cell, insertion.error);
    }
    return made;
  }

  void insert(Insertion& insertion) const {
    const std::size_t cell = insertion.cell;
    std::vector<Gaussian<D>> data;
    gatherUnder(finer_, grid_, finer_scale_, children(cell), data);
    std::vector<Gaussian<D>> current = cells_[cell].references;
    if (current.empty()) current.push_back(coarse_.gaussians[cell]);
    KLKMeansOptions options;
    options.max_swaps = options_.max_swaps;
    options.seed_rule = options_.seed_rule;
    options.worst_rule = options_.worst_rule;
    options.seed = seedOf(coarse_.keys[cell], current.size());
    insertion.clustering = insertCluster(data, current, options);
    insertion.error = cellError(insertion.clustering.references, data);
  }

  /// Own numbers for every insertion, whoever makes it and when.
  std::uint64_t seedOf(const CellKey<D>& key, std::size_t clusters) const {
    std::uint64_t part = Random(static_cast<std::uint64_t>(finer_scale_)).bits();
    for (const std::int32_t coordinate : key) part = Random(part ^ static_cast<std::uint32_t>(coordinate)).bits();
    return Random::forPart(options_.seed, part ^ clusters).bits();
  }

  void writeBack() {
    std::vector<Gaussian<D>> gaussians;
    coarse_.first_gaussian.clear();
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      const auto first = static_cast<std::uint32_t>(gaussians.size());
      coarse_.first_gaussian.push_back(first);
      const IndexRange under = gaussiansUnder(cell);
      const CellClusters<D>& clusters = cells_[cell];
      for (std::size_t i = under.first; i < under.last; ++i)
        finer_.parent[i] =
            first + static_cast<std::uint32_t>(clusters.labels.empty() ? 0 : clusters.labels[i - under.first]);
      if (clusters.references.empty())
        gaussians.push_back(coarse_.gaussians[cell]);
      else
        gaussians.insert(gaussians.end(), clusters.references.begin(), clusters.references.end());
    }
    coarse_.first_gaussian.push_back(static_cast<std::uint32_t>(gaussians.size()));
    coarse_.gaussians = std::move(gaussians);
  }

  MapScale<D>& finer_;
  MapScale<D>& coarse_;
  const Grid<D>& grid_;
  int finer_scale_;
  const RefineOptions& options_;
  std::vector<CellClusters<D>> cells_;
  std::priority_queue<QueuedCell> queue_;
  std::vector<Insertion> insertions_;
};

}  // namespace

template <int D>
GaussianMap<D> refine(GaussianMap<D> map, const RefineOptions& options) {
  checkOptions(options);
  if (map.empty() || map.scales() == 1) return map;
  std::vector<MapScale<D>> scales = {map.scale(0)};
  for (int finer_scale = 0; finer_scale + 1 < map.scales(); ++finer_scale) {
    MapScale<D> coarse = coarsen(scales.back(), map.grid(), finer_scale);
    ScaleRefiner<D>(scales.back(), coarse, map.grid(), finer_scale, options).run();
    scales.push_back(std::move(coarse));
  }
  return GaussianMap<D>(map.options(), std::move(scales));
}

template GaussianMap<2> refine<2>(GaussianMap<2>, const RefineOptions&);
template GaussianMap<3> refine<3>(GaussianMap<3>, const RefineOptions&);

}  // namespace gaussmap
