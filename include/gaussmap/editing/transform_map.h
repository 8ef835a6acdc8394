// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Covariance of a pose in D dimensions, 6 x 6 or 3 x 3: of the translation [m], then of a small rotation [rad] about
/// the target's axes (x y z, or the plane's normal) through the origin of what is moved.
template <int D>
using PoseCovariance = Eigen::Matrix<double, D*(D + 1) / 2, D*(D + 1) / 2, Eigen::DontAlign>;

/// p_target = R p + t.
template <int D>
struct GAUSSMAP_API RigidMotion {
  Matrix<D> rotation = Matrix<D>::Identity();   ///< R, orthogonal, determinant 1
  Vector<D> translation = Vector<D>::Zero();    ///< t [m]
  std::optional<PoseCovariance<D>> covariance;  ///< how well R and t are known; nothing: exactly

  RigidMotion inverse() const;
};

/// The same as a pose of unit quaternion.
GAUSSMAP_API RigidMotion<3> rigidMotion(const Pose& pose);

struct TransformOptions {
  std::optional<MapOptions> grid;            ///< of the result; nothing: that of the map
  MergeCost merge_cost = MergeCost::Volume;  ///< where clusters of a coarse cell have to become fewer
  int threads = 0;                           ///< 0 = all; never shows in the result
};

/// A map moved into another frame, and into another grid if one is given.
///
/// Finest scale. Every Gaussian is moved and sorted into the cell of its mean, where it stays for itself: a cell may
/// hold several then, and moving back gives every mean and every weight of the scale again. A covariance of the motion
/// is added, as it acts at the mean. In cells of another side Gaussians that meet become one; one that comes from a
/// larger cell is halved before, along its long axis, as long as it is longer than a cell there (uniform: sqrt(12)
/// standard deviations) and its halves lie in different cells. All of this keeps weight, mean and covariance of what is
/// there.
///
/// Coarse scales of the same grid: clusters of scale 1 are cut at the borders of the new cells, then merged within them
/// (agglomerate()) where it costs least, until there are as many as before, one a cell at least; coarser scales are
/// made anew from what is below, as many as before. In another grid, as many a cell as before (refine()). All are
/// exact moment matches.
///
/// The identity gives the same map. Otherwise no exact moments are left: the result takes no more scans.
/// Throws std::invalid_argument for a rotation that is none, a covariance that is not finite, symmetric and positive
/// semi-definite, options of no grid, and a compressed map; std::out_of_range for a mean too far for the cells.
template <int D>
GAUSSMAP_API GaussianMap<D> transformMap(const GaussianMap<D>& map, const RigidMotion<D>& motion,
                                         const TransformOptions& options = {});

}  // namespace gaussmap
