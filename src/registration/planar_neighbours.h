// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "registration/planar_equations.h"

namespace gaussmap::detail {

/// A Gaussian of a planar map, prepared for the residuals.
struct PlanarTarget {
  Vector<2> mean;        ///< [m], relative to the origin of the registration
  Matrix<2> cov;         ///< [m^2], without blur
  Matrix<2> directions;  ///< unit axes, one per column, the thinner one first
  Vector<2> variances;   ///< along the axes [m^2], without blur
  Vector<2> tells;       ///< weight per axis: 1 if thin; 0 if it fills its cell, so that shifts along it are not seen
  double count;          ///< number of points
};

/// Pairs the Gaussians of a planar scan with those of one scale of a map, for any pose of the scan. The scan and the
/// map must live as long as this object.
///
/// The candidates for a Gaussian of the scan are the Gaussians in the four cells that meet at the nearest cell corner.
/// They are looked up again only when this corner changes.
class PlanarNeighbours {
 public:
  PlanarNeighbours(const GaussianMap<2>& map, int scale, const std::vector<Gaussian<2>>& scan, const Vector<2>& origin);

  /// Returns the normal equations at a pose, with the Gaussians of the map widened by the standard deviation `blur`
  /// [m]. Each Gaussian of the scan is paired with the one of smallest Mahalanobis distance.
  PlanarEquations linearise(const PlanarPose& pose, double blur, double kernel);

  /// Returns the Gaussian of the map with the smallest Mahalanobis distance from `point`. This is the place of Gaussian
  /// `i` of the scan [m, relative to the origin]. Returns nullptr if the four cells have no Gaussian. The pointer is
  /// valid until the next call.
  const PlanarTarget* nearest(std::size_t i, const Vector<2>& point, double blur);

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Candidates {
    CellKey<2> low{};  // of the four cells, the one with the lowest coordinates
    bool known = false;
    std::vector<std::uint32_t> targets;  // in targets_
  };

  void lookUp(Candidates& candidates, const Vector<2>& point);
  std::uint32_t targetOf(std::size_t gaussian, const Vector<2>& centre);

  const GaussianMap<2>& map_;
  const int scale_;
  const std::vector<Gaussian<2>>& scan_;
  const Vector<2> origin_;
  std::vector<Candidates> candidates_;  // per Gaussian of the scan
  std::vector<std::uint32_t> place_;    // per Gaussian of the scale: its place in targets_, or kNone
  std::vector<PlanarTarget> targets_;
};

}  // namespace gaussmap::detail
