// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// One Gaussian of a map.
struct GaussianId {
  int scale = 0;
  std::size_t index = 0;  ///< in its scale
  friend bool operator==(const GaussianId& a, const GaussianId& b) { return a.scale == b.scale && a.index == b.index; }
};

/// All Gaussians of one scale, in its order. Throws std::out_of_range for a scale that the map does not have.
template <int D>
GAUSSMAP_API std::vector<GaussianId> gaussiansOfScale(const GaussianMap<D>& map, int scale);

/// The Gaussians of the leaves: the finest scale, and where compress() deleted it, the coarse cells that are left.
/// Together they represent every point once. Finest first, each scale in its order. For a map that is not compressed:
/// its finest scale.
template <int D>
GAUSSMAP_API std::vector<GaussianId> leaves(const GaussianMap<D>& map);

/// How much of a scale lies in leaves (GaussianMap::isLeaf()).
struct LeafCounts {
  std::size_t cells = 0;
  std::size_t gaussians = 0;
  double weight = 0.0;  ///< points
};
template <int D>
GAUSSMAP_API LeafCounts leafCounts(const GaussianMap<D>& map, int scale);

/// The box of the occupied cells, each at the finest scale that the map has there; nullopt for an empty map.
template <int D>
GAUSSMAP_API std::optional<Box<D>> extentOf(const GaussianMap<D>& map);

/// ln of the map's density at a point [1/m^D]: the mixture of the Gaussians in the point's cell and the cells
/// next to it, weights divided by the weight of the whole scale. Minus infinity where all these cells are empty.
/// Throws std::out_of_range for a point that has no cell.
template <int D>
GAUSSMAP_API double logLikelihood(const GaussianMap<D>& map, const Vector<D>& point, int scale);
/// The same for the leaves of the map: at every scale, the leaves among the point's cell and those next to it. The
/// weights are divided by the weight of the whole map.
template <int D>
GAUSSMAP_API double logLikelihood(const GaussianMap<D>& map, const Vector<D>& point);

template <int D>
struct NearestGaussian {
  std::size_t index;  ///< Gaussian of the scale asked for
  double distance;    ///< of its mean to the point [m]
};
/// The Gaussian of a scale whose mean is nearest to a point (Euclidean, ties to the smaller index), however far;
/// nullopt if the scale is empty. Throws std::out_of_range for a point that has no cell.
template <int D>
GAUSSMAP_API std::optional<NearestGaussian<D>> nearest(const GaussianMap<D>& map, const Vector<D>& point, int scale);

/// Unit normal of the surface at a point, from the finest cell around it whose points span a surface: at least
/// D + 1 points, and spread of at least 4 noise floors along every axis but the normal. The sign is arbitrary.
/// Returns nullopt if no scale has such a cell. Throws std::out_of_range for a point that has no cell.
template <int D>
GAUSSMAP_API std::optional<Vector<D>> normalAt(const GaussianMap<D>& map, const Vector<D>& point);

/// Log-odds that something is at a point [m, map frame]: those of the Gaussian nearest to the point (Mahalanobis) in
/// the finest cell that contains it. Returns nullopt if no cell contains the point, or if the point is not finite or
/// out of range.
template <int D>
GAUSSMAP_API std::optional<float> logOddsAt(const GaussianMap<D>& map, const Vector<D>& point);

}  // namespace gaussmap
