// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "mapping/scale_clusters.h"

namespace gaussmap::detail {

/// What a coarse scale is made from when cells have changed and old clusters shall live on in them.
template <int D>
struct Regrouping {
  MapScale<D>& finer;   ///< the scale below, in its new cells
  const Grid<D>& grid;  ///< of the new cells
  int scale;            ///< the one to be made
  /// Of each finer Gaussian, the old cluster that it comes from.
  const std::vector<std::uint32_t>& group;
  /// Of each finer Gaussian, the finest cells that it stands for.
  const std::vector<double>& areas;
  int threads;
};

/// A new coarse scale: the finer Gaussians of a cell that come from one old cluster are a cluster again, the exact
/// moment match of them; then clusters of a cell are merged as `cut` says, which is asked with the scale as it is by
/// then and the areas of its clusters.
template <int D>
struct Regrouped {
  MapScale<D> scale;                 ///< without parents
  std::vector<std::uint32_t> group;  ///< of each of its clusters: the old one that most of its weight was in
  std::vector<double> areas;         ///< of its clusters
};
template <int D>
Regrouped<D> regroup(const Regrouping<D>& from,
                     const std::function<ClusterCut(const MapScale<D>&, const std::vector<double>& areas)>& cut);

}  // namespace gaussmap::detail
