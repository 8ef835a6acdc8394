// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "mapping/scale_clusters.h"

namespace gaussmap::detail {

/// Input of recluster(), which rebuilds a coarse scale after its cells have changed and keeps old clusters if possible.
template <int D>
struct ReclusterInput {
  MapScale<D>& finer;   ///< the next finer scale, in its new cells
  const Grid<D>& grid;  ///< grid of the new cells
  int scale;            ///< the scale to make
  /// Per finer Gaussian: the old cluster that it belonged to.
  const std::vector<std::uint32_t>& group;
  /// Per finer Gaussian: the number of occupied finest cells that it represents.
  const std::vector<double>& areas;
  int threads;
};

/// Result of recluster(): a new coarse scale.
template <int D>
struct ReclusterResult {
  MapScale<D> scale;                 ///< the scale, without parents
  std::vector<std::uint32_t> group;  ///< per cluster: the old cluster with the largest part of its weight
  std::vector<double> areas;         ///< per cluster: the number of occupied finest cells that it represents
};
/// Rebuilds a coarse scale. First, the finer Gaussians of a cell that belonged to one old cluster become one cluster,
/// their exact moment match. Then the function calls `cut` with the scale and the areas of its clusters, and merges the
/// clusters of each cell according to the result.
template <int D>
ReclusterResult<D> recluster(
    const ReclusterInput<D>& from,
    const std::function<ClusterCut(const MapScale<D>&, const std::vector<double>& areas)>& cut);

}  // namespace gaussmap::detail
