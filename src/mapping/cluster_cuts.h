// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// Which cluster each Gaussian of a scale goes into. Clusters are numbered in the order of the cells.
struct ClusterCut {
  std::vector<std::uint32_t> cluster;  ///< of each Gaussian
  std::size_t clusters = 0;
};

/// Areas of the clusters from those of the Gaussians.
inline std::vector<double> mergedAreas(const std::vector<double>& areas, const ClusterCut& cut) {
  std::vector<double> merged(cut.clusters, 0.0);
  for (std::size_t i = 0; i < areas.size(); ++i) merged[cut.cluster[i]] += areas[i];
  return merged;
}

/// Ways to merge the Gaussians that a scale has within its cells: one dendrogram a cell, from which every number of
/// clusters can be cut. Works on the scale alone, nothing finer is needed. Yguel 2009, sec. 5.4.
template <int D>
class ClusterCuts {
 public:
  /// `areas` = occupied finest cells under each Gaussian. The scale must outlive the cuts.
  ClusterCuts(const MapScale<D>& scale, const Grid<D>& grid, int s, const std::vector<double>& areas, MergeCost cost,
              int threads);

  /// `extra` clusters beyond one a cell, where they save most. Cells to be kept stay as they are and do not count; no
  /// flags: none is.
  ClusterCut withExtra(std::size_t extra, const std::vector<char>& keep = {}) const;

 private:
  std::size_t cells() const { return scale_.keys.size(); }

  const MapScale<D>& scale_;
  int threads_;
  std::vector<Dendrogram> dendrograms_;
};

/// Replaces the Gaussians of scale s by the moment matches of those that go into one cluster; the cluster belongs to
/// the parent that most of its weight belonged to, and is as occupied as the most occupied of them. `finer`, if there
/// is one, is linked to the clusters. The coarser scale has to be matched afterwards (matchClusters()).
template <int D>
void mergeClusters(MapScale<D>& scale, MapScale<D>* finer, const Grid<D>& grid, int s, const ClusterCut& cut);

/// Makes every cluster of scale s the exact moment match of the Gaussians of scale s - 1 that are linked to it, and as
/// occupied as the most occupied of them. A cluster goes that none is linked to any more; in cells with nothing under
/// them all stay.
template <int D>
void matchClusters(MapScale<D>& finer, MapScale<D>& scale, const Grid<D>& grid, int s);

}  // namespace gaussmap::detail
