// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Returns logLikelihood() of many points: one value per point, in their order. The values are natural logarithms of
/// densities in 1/m^D.
///
/// This is faster than one call of logLikelihood() per point: every Gaussian is factorised once, and the cells near a
/// cell are looked up once for all its points. The value is minus infinity if a point's cell and all adjacent cells are
/// empty. `threads`: 0 = all cores. Throws std::out_of_range if the map does not have the scale, or if a point is not
/// finite or out of the grid's range. Throws std::domain_error if a covariance is not positive definite.
template <int D>
GAUSSMAP_API std::vector<double> logLikelihoods(const GaussianMap<D>& map, int scale,
                                                const std::vector<Vector<D>>& points, int threads = 0);
/// Returns logLikelihood() of many points from the leaves of the map: one value per point, in their order.
///
/// The function looks at the cell of a point and the adjacent cells, at every scale. Of these cells, only leaf cells
/// contribute their Gaussians. The weights are divided by the weight of the whole map. `threads`: 0 = all cores. Throws
/// like logLikelihoods() of one scale.
template <int D>
GAUSSMAP_API std::vector<double> logLikelihoods(const GaussianMap<D>& map, const std::vector<Vector<D>>& points,
                                                int threads = 0);

/// Options of heldOutLogLikelihood().
struct HeldOutOptions {
  double background = 0.01;  ///< epsilon, weight of the uniform density 1 / V, in (0, 1)
  double volume = 0.0;       ///< V, volume of this density [m^D]; 0: box around all points, each side at least 1 m
  int threads = 0;           ///< 0 = all cores
};

/// How well a map predicts points.
///
/// The map's density p is mixed with a uniform density 1 / V. A point where p = 0 then has a low score, but not minus
/// infinity.
/// Each point scores ln((1 - epsilon) p(x) + epsilon / V) [nat, p in 1/m^D]. A larger score is better. Compare maps
/// only with the same points and options, so that V is the same.
struct HeldOutResult {
  double mean = 0.0;           ///< mean score of all points [nat]
  double median = 0.0;         ///< median score, by nearest rank [nat]
  double mean_inside = 0.0;    ///< mean of ln p over the points where p > 0 [nat]; NaN if there are none
  double floor = 0.0;          ///< ln(epsilon / V), the score of a point where p = 0 [nat]
  double volume = 0.0;         ///< V that was used [m^D]
  std::size_t count = 0;       ///< number of points
  std::size_t in_no_cell = 0;  ///< number of points whose own cell is empty
  std::size_t nowhere = 0;     ///< number of points whose own and adjacent cells are all empty: p = 0
};

/// Scores one scale of a map with points that were not used to build it.
///
/// Throws like logLikelihoods(), and std::invalid_argument if there are no points or an option is out of range (the
/// message names it).
template <int D>
GAUSSMAP_API HeldOutResult heldOutLogLikelihood(const GaussianMap<D>& map, int scale,
                                                const std::vector<Vector<D>>& points,
                                                const HeldOutOptions& options = {});
/// Scores the leaves of a map with points that were not used to build it. HeldOutResult::in_no_cell counts the points
/// that lie in no leaf cell. Throws like heldOutLogLikelihood() of one scale.
template <int D>
GAUSSMAP_API HeldOutResult heldOutLogLikelihood(const GaussianMap<D>& map, const std::vector<Vector<D>>& points,
                                                const HeldOutOptions& options = {});

}  // namespace gaussmap
