// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "mapping/scale_clusters.h"

namespace gaussmap::detail {

/// What a coarse scale is rebuilt from after its cells have changed, so that its old clusters are kept where possible.
template <int D>
struct ReclusterInput {
  MapScale<D>& finer;   ///< the scale below, in its new cells
  const Grid<D>& grid;  ///< of the new cells
  int scale;            ///< the one to be made
  /// Of each finer Gaussian, the old cluster that it belonged to.
  const std::vector<std::uint32_t>& group;
  /// Of each finer Gaussian, the number of occupied finest cells that it represents.
  const std::vector<double>& areas;
  int threads;
};

/// A new coarse scale. The finer Gaussians of a cell that belonged to one old cluster become one cluster, their exact
/// moment match. Then clusters of a cell are merged as `cut` says, which gets that scale and the areas of its clusters.
template <int D>
struct ReclusterResult {
  MapScale<D> scale;                 ///< without parents
  std::vector<std::uint32_t> group;  ///< of each of its clusters: the old one that most of its weight was in
  std::vector<double> areas;         ///< of its clusters
};
template <int D>
ReclusterResult<D> recluster(
    const ReclusterInput<D>& from,
    const std::function<ClusterCut(const MapScale<D>&, const std::vector<double>& areas)>& cut);

}  // namespace gaussmap::detail
