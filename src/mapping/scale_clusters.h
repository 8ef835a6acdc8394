// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"
#include "map/coarsen.h"

namespace gaussmap::detail {

/// Two consecutive scales. The coarse scale comes from coarsen(): one Gaussian per cell.
template <int D>
struct ScalePair {
  MapScale<D>& finer;
  MapScale<D>& coarse;
  const Grid<D>& grid;
  int finer_scale;

  std::size_t cells() const { return coarse.keys.size(); }
  IndexRange children(std::size_t cell) const { return {coarse.first_child[cell], coarse.first_child[cell + 1]}; }
  /// The finer Gaussians under a coarse cell, as indices of the finer scale: G(phi(c)), Yguel 2009 sec. 5.1.
  IndexRange gaussiansUnder(std::size_t cell) const {
    const IndexRange below = children(cell);
    return {gaussiansOf(finer, below.first).first, gaussiansOf(finer, below.last - 1).last};
  }
  /// The Gaussians of gaussiansUnder(), with means about the centre of the coarse cell [m].
  std::vector<Gaussian<D>> dataUnder(std::size_t cell) const {
    std::vector<Gaussian<D>> data;
    gatherUnder(finer, grid, finer_scale, children(cell), data);
    return data;
  }
};

/// Assigns every Gaussian of a scale to a cluster. Clusters are numbered in the order of their cells.
struct ClusterCut {
  std::vector<std::uint32_t> cluster;  ///< cluster per Gaussian
  std::vector<std::uint32_t> first;    ///< first cluster per cell, n + 1 for n cells

  std::size_t clusters() const { return first.back(); }
};

/// Agglomerates the Gaussians of a cell. MergeCost::KL takes them as they are, as in the paper. With the other costs,
/// the clustering noise is added first; `finest_side` = side of a finest cell [m].
template <int D>
Dendrogram agglomerateCell(std::vector<Gaussian<D>> data, const std::vector<double>& areas, double finest_side,
                           MergeCost cost);

/// Returns the moment matches of `parts` clusters; label[i] in [0, parts) is the cluster of Gaussian i.
template <int D>
std::vector<Gaussian<D>> clustersOf(const std::vector<Gaussian<D>>& data, const std::vector<int>& label,
                                    std::size_t parts);

/// Returns the labels after one run of KLKMeans that starts from these clusters (Yguel 2009, sec. 5.4). The run can
/// drop clusters. The labels that are left are 0, 1, ...
template <int D>
std::vector<int> smoothedLabels(const std::vector<Gaussian<D>>& data, const std::vector<int>& label, std::size_t parts);

/// Groups the Gaussians of each cell into any smaller number of clusters. One dendrogram per cell (agglomerate()) holds
/// the groups for all numbers of clusters. partsPerCell() decides how many clusters each cell gets.
class GAUSSMAP_API ScaleClusters {
 public:
  /// Clusters the finer Gaussians under each coarse cell. `areas` = number of occupied finest cells per finer Gaussian.
  template <int D>
  static ScaleClusters under(const ScalePair<D>& pair, const std::vector<double>& areas, MergeCost cost, int threads);

  /// Clusters the Gaussians that the cells of scale s hold themselves, so no finer scale is needed (Yguel 2009, sec.
  /// 5.4). `areas` = number of occupied finest cells per Gaussian. Cells with a flag in `keep` keep all their
  /// Gaussians, and cut() does not count these. If `keep` is empty, no cell has a flag.
  template <int D>
  static ScaleClusters within(const MapScale<D>& scale, const Grid<D>& grid, int s, const std::vector<double>& areas,
                              MergeCost cost, int threads, const std::vector<char>& keep = {});

  /// Uses the dendrograms() of an earlier object.
  ScaleClusters(std::vector<Dendrogram> dendrograms, int threads);

  const std::vector<Dendrogram>& dendrograms() const { return dendrograms_; }
  const std::vector<std::vector<double>>& gains() const { return gains_; }  ///< mergeGains() per cell
  std::size_t maxExtra() const;  ///< maximum number of clusters beyond one per cell: one cluster per Gaussian

  /// Gives `extra` clusters beyond one per cell to the cells where they gain most.
  ClusterCut cut(std::size_t extra) const;
  /// Gives cell i the number of clusters parts[i].
  ClusterCut cut(const std::vector<std::size_t>& parts) const;

 private:
  explicit ScaleClusters(std::size_t cells, int threads) : dendrograms_(cells), gains_(cells), threads_(threads) {}

  std::vector<Dendrogram> dendrograms_;  // if one has no merges, the cell keeps all its Gaussians
  std::vector<std::vector<double>> gains_;
  int threads_;
};

/// Puts all Gaussians of each cell into one cluster.
template <int D>
ClusterCut onePerCell(const MapScale<D>& scale);

/// Returns the cut of scale s after smoothedLabels() in every cell in which it merges Gaussians.
template <int D>
ClusterCut smoothed(const MapScale<D>& scale, const Grid<D>& grid, int s, const ClusterCut& cut, int threads);

/// Returns the area of each cluster: the sum of the areas of its Gaussians.
std::vector<double> mergedAreas(const std::vector<double>& areas, const ClusterCut& cut);

/// Returns the clusters of a cut of the finer Gaussians. Each is the exact moment match of its members, by their
/// weights; its mean is about the centre of its cell [m].
template <int D>
std::vector<Gaussian<D>> clusterGaussians(const ScalePair<D>& pair, const ClusterCut& cut, int threads);

/// Replaces the Gaussians of the coarse scale by the clusters of a cut of the finer Gaussians. Links the finer
/// Gaussians to their clusters.
template <int D>
GAUSSMAP_API void setClusters(const ScalePair<D>& pair, ClusterCut cut, int threads);

/// Replaces the Gaussians of scale s by the clusters of a cut. Each cluster is the moment match of its members and has
/// their maximum log-odds. Its parent is the parent with the largest part of its weight. If `finer` is not null, its
/// Gaussians are linked to the clusters. Afterwards call matchClusters() for the next coarser scale.
template <int D>
void mergeClusters(MapScale<D>& scale, MapScale<D>* finer, const Grid<D>& grid, int s, const ClusterCut& cut);

/// Makes every cluster of scale s the exact moment match of its children, with their maximum log-odds. Removes clusters
/// that have no children left. Leaves of scale s keep their clusters.
template <int D>
void matchClusters(MapScale<D>& finer, MapScale<D>& scale, const Grid<D>& grid, int s);

}  // namespace gaussmap::detail
