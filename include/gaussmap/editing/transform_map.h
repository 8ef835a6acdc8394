// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of transformMap().
struct TransformOptions {
  std::optional<MapOptions> grid;            ///< grid of the result; std::nullopt: the grid of the map
  std::optional<PoseCovariance> covariance;  ///< covariance of the motion; std::nullopt: it is exact
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair of clusters of a coarse cell is merged next
  int threads = 0;                           ///< 0 = all cores
};

/// Transforms a map into another frame, and resamples it if a grid is given. `motion`: p_target = R p + t.
///
/// Finest scale in cells of the same side: Every Gaussian is transformed and sorted into the cell that contains its new
/// mean. Gaussians that share a cell are not merged, so the inverse motion restores all means and weights. The
/// covariance of the motion is propagated to each mean and added to the covariance of the Gaussian.
///
/// Finest scale in cells of another side: All Gaussians of a new cell are merged into one. If the new cells are
/// smaller, long Gaussians are first halved along their longest axis. This repeats while a Gaussian is longer than a
/// new cell and its halves lie in different cells. Its length is sqrt(12) standard deviations, as for a uniform rod.
/// Halving and merging keep the total weight, mean and covariance.
///
/// Coarse scales in the same grid: At scale 1, the borders of the new cells cut the clusters into parts. agglomerate()
/// then merges the cheapest pairs of parts within the cells. It stops when the scale has as many clusters as before, or
/// one per cell. A coarser scale is rebuilt in the same way, but the merging starts from the Gaussians of the scale
/// below.
///
/// Coarse scales in another grid: refine() rebuilds them with the same mean number of clusters per cell as before. In
/// both grids, every coarse cluster is the exact moment match of its children.
///
/// The identity without a covariance, in the same grid, returns the same map. Any other result has no exact moments and
/// accepts no more scans. For D = 2, only the entries of x, y and the rotation about z of the covariance are used.
///
/// Throws std::invalid_argument in these cases:
/// - The pose has a fault (see poseFault()).
/// - D = 2 and the pose is not planar (z = 0, rotation about z).
/// - The covariance is not finite, symmetric and positive semi-definite.
/// - The options of the grid are not usable, or the map is compressed.
///
/// Throws std::out_of_range if a mean lies beyond the range of the cell indices.
template <int D>
GAUSSMAP_API GaussianMap<D> transformMap(const GaussianMap<D>& map, const Pose& motion,
                                         const TransformOptions& options = {});

}  // namespace gaussmap
