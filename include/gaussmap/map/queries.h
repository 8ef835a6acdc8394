// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Identifies one Gaussian of a map.
struct GaussianId {
  int scale = 0;          ///< scale of the Gaussian
  std::size_t index = 0;  ///< index in this scale
  /// Returns true if both identify the same Gaussian.
  friend bool operator==(const GaussianId& a, const GaussianId& b) { return a.scale == b.scale && a.index == b.index; }
};

/// Returns all Gaussians of one scale, in the order of the scale. Throws std::out_of_range if the map does not have the
/// scale.
template <int D>
GAUSSMAP_API std::vector<GaussianId> gaussiansOfScale(const GaussianMap<D>& map, int scale);

/// Returns the Gaussians of all leaf cells. A leaf cell has no finer cells below it (see GaussianMap::isLeaf()).
///
/// Together the leaves represent every point once. They are ordered by scale, finest first, and then by index. In a
/// compressed map, the leaves are cells of several scales. In any other map, the leaves are the cells of the finest
/// scale.
template <int D>
GAUSSMAP_API std::vector<GaussianId> leaves(const GaussianMap<D>& map);

/// Counts the leaf cells of one scale and their contents (see GaussianMap::isLeaf()).
struct LeafCounts {
  std::size_t cells = 0;      ///< number of leaf cells
  std::size_t gaussians = 0;  ///< number of Gaussians in leaf cells
  double weight = 0.0;        ///< number of points that these Gaussians represent
};

/// Returns the counts of the leaf cells of one scale.
template <int D>
GAUSSMAP_API LeafCounts leafCounts(const GaussianMap<D>& map, int scale);

/// Returns the smallest box around all leaf cells [m, map frame], or std::nullopt if the map is empty.
template <int D>
GAUSSMAP_API std::optional<Box<D>> extentOf(const GaussianMap<D>& map);

/// Returns the logarithm of the map's density at a point, with the density in 1/m^D.
///
/// The density is the mixture of the Gaussians of scale `scale` in the point's cell and the adjacent cells. Their
/// weights are divided by the weight of the whole scale. The result is minus infinity if all these cells are empty.
/// Throws std::out_of_range if the point is not finite or out of the grid's range.
template <int D>
GAUSSMAP_API double logLikelihood(const GaussianMap<D>& map, const Vector<D>& point, int scale);
/// Returns the logarithm of the density of the map's leaves at a point, with the density in 1/m^D.
///
/// The density is the mixture of the Gaussians in leaf cells. At every scale, these are the leaf cells among the
/// point's cell and the adjacent cells. The weights are divided by the weight of the whole map. The result is minus
/// infinity if there are no such cells. Throws std::out_of_range if the point is not finite or out of the grid's range.
template <int D>
GAUSSMAP_API double logLikelihood(const GaussianMap<D>& map, const Vector<D>& point);

/// The result of nearest(): a Gaussian and its distance.
template <int D>
struct NearestGaussian {
  std::size_t index;  ///< index of the Gaussian in the given scale
  double distance;    ///< distance of the Gaussian's mean from the point [m]
};

/// Returns the Gaussian of a scale whose mean is nearest to a point, at any distance, or std::nullopt if the scale is
/// empty.
///
/// The distance is Euclidean; ties go to the smaller index. Throws std::out_of_range if the point is not finite or out
/// of the grid's range.
template <int D>
GAUSSMAP_API std::optional<NearestGaussian<D>> nearest(const GaussianMap<D>& map, const Vector<D>& point, int scale);

/// Returns the unit normal of the surface at a point, or std::nullopt if no scale has a suitable Gaussian there.
///
/// The function looks at the point's cell of one scale after the other, finest first. In the cell it takes the cluster
/// nearest to the point, with the distance of Yguel 2009 eq. (2). This cluster gives the normal if it spans a surface:
/// if it has at least D + 1 points, and if its standard deviation along every axis except the normal is at least 4
/// MapOptions::noise. The sign of the normal is arbitrary. Throws std::out_of_range if the point is not finite or out
/// of the grid's range.
template <int D>
GAUSSMAP_API std::optional<Vector<D>> normalAt(const GaussianMap<D>& map, const Vector<D>& point);

/// Returns the log-odds that something is at a point [m, map frame].
///
/// The leaf cell that contains the point can hold several Gaussians. The value is that of the Gaussian with the
/// smallest Mahalanobis distance from the point. Returns std::nullopt if no leaf cell contains the point, or if the
/// point is not finite or out of the grid's range.
template <int D>
GAUSSMAP_API std::optional<float> logOddsAt(const GaussianMap<D>& map, const Vector<D>& point);

}  // namespace gaussmap
