// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

/// ln of the map's density at a point [1/m^D]: the mixture of the Gaussians in the point's cell and the cells
/// next to it, weights divided by the weight of the whole scale. Minus infinity where all these cells are empty.
/// Throws std::out_of_range for a point that has no cell.
template <int D>
double logLikelihood(const GaussianMap<D>& map, const Vector<D>& point, int scale);
/// The same with the map at its finest, leaves(): of every scale the coarse cells without detail under them among the
/// point's cell and those next to it; weights divided by that of the whole map.
template <int D>
double logLikelihood(const GaussianMap<D>& map, const Vector<D>& point);

/// The Gaussian of a scale whose mean is nearest to a point (Euclidean, ties to the smaller index), however far;
/// nothing if the scale is empty. Throws std::out_of_range for a point that has no cell.
template <int D>
struct Nearest {
  std::size_t index;  ///< Gaussian of the scale asked for
  double distance;    ///< of its mean to the point [m]
};
template <int D>
std::optional<Nearest<D>> nearest(const GaussianMap<D>& map, const Vector<D>& point, int scale);

/// Unit normal of the surface at a point, from the finest cell around it whose points span a surface: at least
/// D + 1 points, and spread of at least 4 noise floors along every axis but the normal. The sign is arbitrary.
/// Nothing where no scale has such a cell. Throws std::out_of_range for a point that has no cell.
template <int D>
std::optional<Vector<D>> normalAt(const GaussianMap<D>& map, const Vector<D>& point);

}  // namespace gaussmap
