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
  std::optional<PoseCovariance> covariance;  ///< of the motion; std::nullopt: the motion is exact
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair of clusters of a coarse cell is merged next
  int threads = 0;                           ///< 0 = all cores
};

/// Transforms a map into another frame, and resamples it if a grid is given. `motion`: p_target = R p + t.
///
/// Finest scale: Every Gaussian is transformed and sorted into the cell that contains its new mean. Gaussians that
/// share a cell are not merged, so the inverse motion restores all means and weights. The covariance of the motion is
/// propagated to each mean and added to the covariance of the Gaussian.
///
/// Finest scale in cells of another side: The Gaussians of a cell are merged into one. Before, a Gaussian from a larger
/// cell is halved along its long axis. This repeats while it is longer than a cell and its halves lie in different
/// cells; its length is that of a uniform rod, sqrt(12) standard deviations. Halving and merging keep the total weight,
/// mean and covariance.
///
/// Coarse scales in the same grid: The clusters of scale 1 are cut at the borders of the new cells. agglomerate() then
/// merges the cheapest pairs within the cells, until the number of clusters is as before, but at least one per cell.
/// The coarser scales are rebuilt from the scale below, with the number of clusters as before.
///
/// Coarse scales in another grid: refine() rebuilds them with the same number of clusters per cell as before. In both
/// cases all clusters are exact moment matches.
///
/// The identity returns the same map. Any other result has no exact moments and accepts no more scans. For D = 2, only
/// x, y and the rotation about z of the covariance are used.
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
