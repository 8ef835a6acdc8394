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

/// Two neighbouring scales. The coarse one is as coarsen() makes it: one Gaussian per cell.
template <int D>
struct ScalePair {
  MapScale<D>& finer;
  MapScale<D>& coarse;
  const Grid<D>& grid;
  int finer_scale;

  std::size_t cells() const { return coarse.keys.size(); }
  IndexRange children(std::size_t cell) const { return {coarse.first_child[cell], coarse.first_child[cell + 1]}; }
  /// G(phi(c)), Yguel 2009 sec. 5.1, as indices of the finer scale.
  IndexRange gaussiansUnder(std::size_t cell) const {
    const IndexRange below = children(cell);
    return {gaussiansOf(finer, below.first).first, gaussiansOf(finer, below.last - 1).last};
  }
  /// The same as Gaussians, means about the centre of the coarse cell.
  std::vector<Gaussian<D>> dataUnder(std::size_t cell) const {
    std::vector<Gaussian<D>> data;
    gatherUnder(finer, grid, finer_scale, children(cell), data);
    return data;
  }
};

/// Which cluster each Gaussian goes into. Clusters are numbered in the order of their cells.
struct ClusterCut {
  std::vector<std::uint32_t> cluster;  ///< per Gaussian
  std::vector<std::uint32_t> first;    ///< first cluster per cell, n + 1 for n cells

  std::size_t clusters() const { return first.back(); }
};

/// All ways to group the Gaussians of each cell into fewer clusters: one dendrogram per cell, from which every number
/// of clusters can be cut (agglomerate()). The rule for how many clusters each cell gets is partsPerCell().
class GAUSSMAP_API ScaleClusters {
 public:
  /// Of the finer Gaussians under each coarse cell. `areas` = occupied finest cells per finer Gaussian.
  template <int D>
  static ScaleClusters under(const ScalePair<D>& pair, const std::vector<double>& areas, MergeCost cost, int threads);

  /// Of the Gaussians that the cells of scale s hold themselves; no finer scale is needed (Yguel 2009, sec. 5.4).
  /// `areas` = occupied finest cells per Gaussian. Cells flagged in `keep` keep their Gaussians and do not count;
  /// empty: no cell is kept.
  template <int D>
  static ScaleClusters within(const MapScale<D>& scale, const Grid<D>& grid, int s, const std::vector<double>& areas,
                              MergeCost cost, int threads, const std::vector<char>& keep = {});

  /// From dendrograms() made before.
  ScaleClusters(std::vector<Dendrogram> dendrograms, int threads);

  const std::vector<Dendrogram>& dendrograms() const { return dendrograms_; }
  const std::vector<std::vector<double>>& gains() const { return gains_; }  ///< mergeGains() per cell
  std::size_t maxExtra() const;  ///< how many clusters beyond one per cell the data allow

  /// `extra` clusters beyond one per cell, where they gain most.
  ClusterCut cut(std::size_t extra) const;
  /// A given number of clusters per cell.
  ClusterCut cut(const std::vector<std::size_t>& parts) const;

 private:
  explicit ScaleClusters(std::size_t cells, int threads) : dendrograms_(cells), gains_(cells), threads_(threads) {}

  std::vector<Dendrogram> dendrograms_;  // without merges: the data of the cell stay apart
  std::vector<std::vector<double>> gains_;
  int threads_;
};

/// One cluster per cell of the Gaussians that the cells hold.
template <int D>
ClusterCut onePerCell(const MapScale<D>& scale);

/// Areas of the clusters from those of the Gaussians.
std::vector<double> mergedAreas(const std::vector<double>& areas, const ClusterCut& cut);

/// The clusters of a cut of the finer Gaussians: exact moment matches by weight, means about the centre of their cell.
template <int D>
std::vector<Gaussian<D>> clusterGaussians(const ScalePair<D>& pair, const ClusterCut& cut, int threads);

/// Replaces the Gaussians of the coarse scale by the clusters of a cut of the finer ones, and links these to them.
template <int D>
GAUSSMAP_API void setClusters(const ScalePair<D>& pair, ClusterCut cut, int threads);

/// Replaces the Gaussians of scale s by the moment matches of those in one cluster. A cluster belongs to the parent
/// that most of its weight belonged to, and has the highest log-odds of its members. `finer`, if given, is linked to
/// the clusters. The coarser scale has to be matched afterwards (matchClusters()).
template <int D>
void mergeClusters(MapScale<D>& scale, MapScale<D>* finer, const Grid<D>& grid, int s, const ClusterCut& cut);

/// Makes every cluster of scale s the exact moment match of the Gaussians of scale s - 1 that are linked to it, with
/// the highest of their log-odds. Removes clusters to which no Gaussian is linked any more; cells without finer cells
/// keep theirs.
template <int D>
void matchClusters(MapScale<D>& finer, MapScale<D>& scale, const Grid<D>& grid, int s);

}  // namespace gaussmap::detail
