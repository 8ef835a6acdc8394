// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "clustering/small_cholesky.h"
#include "core/parallel.h"
#include "mapping/online/online_state.h"

namespace gaussmap::detail {
namespace {

/// Finds the nearest cluster by d(p, w), Yguel 2009 eq. (2). The Cholesky factor of a cluster is computed at its first
/// use.
template <int D>
class NearestCluster {
 public:
  explicit NearestCluster(OnlineClusters<D>& clusters) : clusters_(clusters), factors_(clusters.size()) {}

  std::size_t operator()(const Vector<D>& point) {
    if (clusters_.size() == 1) return 0;
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      if (!factors_[c]) factors_[c].emplace(clusters_[c].gaussian.cov);
      const double distance = 0.5 * ((factors_[c]->whitening * (point - clusters_[c].gaussian.mean)).squaredNorm() +
                                     factors_[c]->logDeterminant());
      if (distance < least) {
        least = distance;
        best = c;
      }
    }
    return best;
  }
  /// Drops the factor of a cluster whose covariance has changed.
  void forget(std::size_t c) { factors_[c].reset(); }

 private:
  OnlineClusters<D>& clusters_;
  std::vector<std::optional<SmallCholesky<D>>> factors_;
};

/// Moves a cluster towards a point, Yguel 2009 Algorithm 1. Every point also adds the variance of the noise floor, so
/// the part of the noise in the covariance stays constant.
template <int D>
void learn(OnlineCluster<D>& cluster, const Vector<D>& point, const OnlineOptions& options, double noise) {
  const double rate = rateOf(double(cluster.log_odds), options);
  Gaussian<D>& gaussian = cluster.gaussian;
  gaussian.mean += rate * (point - gaussian.mean);
  const Vector<D> off = point - gaussian.mean;
  gaussian.cov += rate * (off * off.transpose() + noise * noise * Matrix<D>::Identity() - gaussian.cov);
  gaussian.weight += 1.0;
}

/// Links the cluster of a new finest cell to the nearest cluster of its parent cell. If the parent cell has no cluster,
/// it gets one, which is linked to the next coarser scale in the same way.
template <int D>
void linkUpwards(OnlineCells<D>& cells, std::uint32_t finest) {
  std::uint32_t child = finest;
  for (int scale = 1; scale < cells.scales(); ++scale) {
    OnlineCluster<D>& below = cells.cell(child, scale - 1).clusters.back();
    const std::uint32_t parent = cells.cell(child, scale - 1).parent;
    OnlineClusters<D>& clusters = cells.cell(parent, scale).clusters;
    Gaussian<D> moved = below.gaussian;
    moved.mean += cells.grid().centreInParent(cells.cell(child, scale - 1).key, scale - 1);
    if (!clusters.empty()) {
      below.parent = static_cast<std::uint32_t>(NearestCluster<D>(clusters)(moved.mean));
      return;
    }
    below.parent = 0;
    OnlineCluster<D> first;
    first.gaussian = moved;
    cells.addCluster(parent, scale, first);
    child = parent;
  }
}

template <int D>
void addExactly(OnlineCells<D>& cells, OnlineScan<D>& scan, const OnlineOptions&) {
  const Grid<D>& grid = cells.grid();
  MomentGrid<D> sums(grid.side(0));
  sums.addPoints(scan.points);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const std::uint32_t cell = cells.findOrInsert(sums[i].key);
    cells.moments(cell) += sums[i].moments;
    const bool is_new = cells.cell(cell, 0).clusters.empty();
    if (is_new) cells.addCluster(cell, 0, {});
    cells.cell(cell, 0).clusters[0].gaussian = cells.moments(cell).gaussian(grid.side(0), grid.options().noise);
    if (is_new) {
      linkUpwards(cells, cell);
      scan.new_cells.push_back(cell);
    }
    if (cells.scales() > 1) cells.markStale(cells.cell(cell, 0).parent, 1);
    scan.touched.push_back(cell);
  }
  scan.sums = std::move(sums);
}

/// Every scale learns directly from the points. The cells of a scale are independent of each other. Each cell learns
/// its points in the order of the scan.
template <int D>
void learnAll(OnlineCells<D>& cells, OnlineScan<D>& scan, const OnlineOptions& options) {
  const Grid<D>& grid = cells.grid();
  const double noise = grid.options().noise;
  std::vector<CellKey<D>> keys;  // computed before the map changes, because keyOf() can throw std::out_of_range
  for (const Vector<D>& point : scan.points) keys.push_back(grid.keyOf(point));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> finest;  // cell, point
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const CellKey<D>& key = keys[i];
    const std::uint32_t cell = cells.findOrInsert(key);
    finest.emplace_back(cell, static_cast<std::uint32_t>(i));
    OnlineClusters<D>& clusters = cells.cell(cell, 0).clusters;
    if (clusters.empty()) {
      OnlineCluster<D> first;
      first.gaussian.mean = scan.points[i] - grid.centre(key, 0);
      first.gaussian.cov = noise * noise * Matrix<D>::Identity();
      first.gaussian.weight = 0.0;  // learn() counts the point
      cells.addCluster(cell, 0, first);
      linkUpwards(cells, cell);
      scan.new_cells.push_back(cell);
    }
  }
  parallelFor(static_cast<std::size_t>(cells.scales()), options.threads, 1, [&](std::size_t level) {
    const int scale = static_cast<int>(level);
    auto order = finest;
    for (auto& [cell, point] : order)
      for (int s = 0; s < scale; ++s) cell = cells.cell(cell, s).parent;
    std::sort(order.begin(), order.end());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      OnlineCell<D>& cell = cells.cell(order[begin].first, scale);
      const Vector<D> centre = grid.centre(cell.key, scale);
      NearestCluster<D> nearest(cell.clusters);
      for (end = begin; end < order.size() && order[end].first == order[begin].first; ++end) {
        const Vector<D> point = scan.points[order[end].second] - centre;
        const std::size_t c = nearest(point);
        learn(cell.clusters[c], point, options, noise);
        nearest.forget(c);
      }
    }
  });
  for (const auto& [cell, point] : finest)
    if (scan.touched.empty() || scan.touched.back() != cell) scan.touched.push_back(cell);
  std::sort(scan.touched.begin(), scan.touched.end());
  scan.touched.erase(std::unique(scan.touched.begin(), scan.touched.end()), scan.touched.end());
}

}  // namespace

template <int D>
void updateByPoints(OnlineCells<D>& cells, OnlineScan<D>& scan, const OnlineOptions& options) {
  if (options.learning_rate == LearningRate::SampleMean)
    addExactly(cells, scan, options);
  else
    learnAll(cells, scan, options);
}

template <int D>
void restoreCell(OnlineCells<D>& cells, const RemovedCluster<D>& removed, const OnlineOptions& options) {
  const Grid<D>& grid = cells.grid();
  const std::uint32_t cell = cells.findOrInsert(removed.key);
  OnlineCluster<D> back;
  back.gaussian = removed.gaussian;
  back.gaussian.mean -= grid.centre(removed.key, 0);
  back.log_odds = static_cast<float>(options.occupancy.max_log_odds);  // otherwise, the next miss would delete it again
  back.evidence = removed.evidence;
  const bool is_new = cells.cell(cell, 0).clusters.empty();
  if (is_new) cells.addCluster(cell, 0, back);
  OnlineCluster<D>& cluster = cells.cell(cell, 0).clusters[0];
  if (options.learning_rate == LearningRate::SampleMean) {
    cells.moments(cell) += removed.moments;
    cluster.gaussian = cells.moments(cell).gaussian(grid.side(0), grid.options().noise);
  } else if (!is_new) {
    cluster.gaussian = merge<D>({cluster.gaussian, back.gaussian});
  }
  if (is_new) linkUpwards(cells, cell);
  if (cells.scales() > 1) cells.markStale(cells.cell(cell, 0).parent, 1);
}

template void restoreCell<2>(OnlineCells<2>&, const RemovedCluster<2>&, const OnlineOptions&);
template void restoreCell<3>(OnlineCells<3>&, const RemovedCluster<3>&, const OnlineOptions&);
template void updateByPoints<2>(OnlineCells<2>&, OnlineScan<2>&, const OnlineOptions&);
template void updateByPoints<3>(OnlineCells<3>&, OnlineScan<3>&, const OnlineOptions&);

}  // namespace gaussmap::detail
