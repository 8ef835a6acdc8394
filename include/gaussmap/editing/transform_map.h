// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct TransformOptions {
  std::optional<MapOptions> grid;            ///< of the result; std::nullopt: that of the map
  std::optional<PoseCovariance> covariance;  ///< how well the motion is known; std::nullopt: exactly
  MergeCost merge_cost = MergeCost::Volume;  ///< where clusters of a coarse cell have to become fewer
  int threads = 0;                           ///< 0 = all; never shows in the result
};

/// Moves a map into another frame, and into another grid if one is given. `motion`: p_target = R p + t.
///
/// Finest scale. Every Gaussian is moved and sorted into the cell that contains its new mean. Gaussians that share a
/// cell are not merged, so that moving back restores all means and weights of the scale. The covariance of the motion
/// is added to each covariance, as it acts at the mean. In a grid with cells of another side, all Gaussians of a cell
/// are merged. One from a larger cell is first halved along its long axis, as long as it is longer than a cell (as a
/// uniform rod: sqrt(12) standard deviations) and its halves lie in different cells. All of this keeps total weight,
/// mean and covariance.
///
/// Coarse scales of the same grid: the clusters of scale 1 are cut at the borders of the new cells, then merged within
/// them (agglomerate()) where it costs least, until there are as many as before, but at least one per cell. Coarser
/// scales are rebuilt from the scale below, with as many clusters as before. In another grid, the number of clusters
/// per cell stays as before (refine()). All are exact moment matches.
///
/// The identity returns the same map. Otherwise the result has no exact moments and accepts no more scans.
/// For D = 2 the pose must be planar (z = 0, rotation about z), and only x, y and the rotation about z of the
/// covariance count. Throws std::invalid_argument for a pose with a fault (poseFault()) or one that is not planar, a
/// covariance that is not finite, symmetric and positive semi-definite, unusable grid options, and a compressed map;
/// std::out_of_range for a mean outside the range of cell indices.
template <int D>
GAUSSMAP_API GaussianMap<D> transformMap(const GaussianMap<D>& map, const Pose& motion,
                                         const TransformOptions& options = {});

}  // namespace gaussmap
