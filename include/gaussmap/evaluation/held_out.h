// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// logLikelihood() of many points [1/m^D], n values in their order: every Gaussian is factorised once, and the cells
/// around are looked up once for all points of a cell. Minus infinity where a point's cell and all cells next to it
/// are empty. `threads` = 0: all; the result is the same to the last bit for any number.
/// Throws std::out_of_range for a scale that the map does not have, or a point that has no cell (also if it is not
/// finite); std::domain_error if a covariance is not positive definite.
template <int D>
GAUSSMAP_API std::vector<double> logLikelihoods(const GaussianMap<D>& map, int scale,
                                                const std::vector<Vector<D>>& points, int threads = 0);
/// The same with the map at its finest, leaves(): of every scale the coarse cells without detail under them among the
/// point's cell and those next to it; weights divided by that of the whole map.
template <int D>
GAUSSMAP_API std::vector<double> logLikelihoods(const GaussianMap<D>& map, const std::vector<Vector<D>>& points,
                                                int threads = 0);

struct HeldOutOptions {
  double background = 0.01;  ///< epsilon, share of the points that may come from anywhere, in (0, 1)
  double volume = 0.0;       ///< V, where 'anywhere' is [m^D]; 0: the box around the points, each side at least 1 m
  int threads = 0;           ///< 0 = all; never shows in the result
};

/// How well a map foretells points. The map's density p is mixed with a uniform one, so that a point where the map
/// has nothing costs much but not everything: each point counts ln((1 - epsilon) p(x) + epsilon / V) [nat, p in 1/m^D].
/// Larger is better. Compare maps by the same points and options only: V is the same for all of them then.
struct HeldOutResult {
  double mean = 0.0;           ///< over all points [nat]
  double median = 0.0;         ///< by nearest rank [nat]
  double mean_inside = 0.0;    ///< over the points where p > 0, of ln p alone [nat]; NaN if there are none
  double floor = 0.0;          ///< ln(epsilon / V), what a point counts where p is 0 [nat]
  double volume = 0.0;         ///< V that was used [m^D]
  std::size_t count = 0;       ///< points
  std::size_t in_no_cell = 0;  ///< of them, whose own cell is empty
  std::size_t nowhere = 0;     ///< of these, with the cells next to it empty too: p = 0
};

/// Scores points of which none was used to build the map. Throws as logLikelihoods(), and std::invalid_argument if
/// there are no points or an option makes no sense (naming it).
template <int D>
GAUSSMAP_API HeldOutResult heldOutLogLikelihood(const GaussianMap<D>& map, int scale,
                                                const std::vector<Vector<D>>& points,
                                                const HeldOutOptions& options = {});
/// The same with the map at its finest. A point lies in no cell if none that it lies in is a leaf.
template <int D>
GAUSSMAP_API HeldOutResult heldOutLogLikelihood(const GaussianMap<D>& map, const std::vector<Vector<D>>& points,
                                                const HeldOutOptions& options = {});

}  // namespace gaussmap
