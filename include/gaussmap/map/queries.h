// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
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

/// The result of nearest() without `k`: one Gaussian of the scale that was searched.
template <int D>
struct NearestGaussian {
  std::size_t index;  ///< index of the Gaussian in this scale
  double distance;    ///< distance of the Gaussian's mean from the point [m]
};

/// One result of a search that can return several Gaussians, or Gaussians of several scales.
struct FoundGaussian {
  GaussianId id;          ///< scale and index of the Gaussian
  double distance = 0.0;  ///< distance of the Gaussian's mean from the point [m]
};

/// Returns the Gaussian of a scale whose mean is nearest to a point [m, map frame]. Returns std::nullopt if the scale
/// is empty.
///
/// The distance is Euclidean and has no limit. If several means are equally near, returns the one with the smallest
/// index. The search needs no preparation. For many queries of one map, MapSearch is faster. Throws std::out_of_range
/// if the map does not have the scale, or if the point is not finite or out of the grid's range.
template <int D>
GAUSSMAP_API std::optional<NearestGaussian<D>> nearest(const GaussianMap<D>& map, const Vector<D>& point, int scale);
/// Returns the `k` Gaussians of a scale whose means are nearest to a point, or all if the scale has fewer. They are
/// sorted by distance, then by index. The order of the numbers matters: `k` comes first, then `scale`.
///
/// Throws std::out_of_range like nearest() without `k`, and std::invalid_argument if `k` is negative.
template <int D>
GAUSSMAP_API std::vector<FoundGaussian> nearestK(const GaussianMap<D>& map, const Vector<D>& point, int k, int scale);
/// Returns the Gaussians of a scale whose means are at most `radius` [m] from a point, sorted by distance, then by
/// index. Throws std::out_of_range like nearest(), and std::invalid_argument if the radius is negative or NaN.
template <int D>
GAUSSMAP_API std::vector<FoundGaussian> within(const GaussianMap<D>& map, const Vector<D>& point, double radius,
                                               int scale);

/// Returns the `k` Gaussians of the leaves (see leaves()) whose means are nearest to a point, or all if the map has
/// fewer. They are sorted by distance, then by scale (finest first), then by index.
///
/// Throws std::out_of_range if the point is not finite or out of the grid's range, and std::invalid_argument if `k` is
/// negative.
template <int D>
GAUSSMAP_API std::vector<FoundGaussian> nearestLeaves(const GaussianMap<D>& map, const Vector<D>& point, int k);
/// Returns the Gaussians of the leaves whose means are at most `radius` [m] from a point, in the order of
/// nearestLeaves().
///
/// Throws std::out_of_range if the point is not finite or out of the grid's range, and std::invalid_argument if the
/// radius is negative or NaN.
template <int D>
GAUSSMAP_API std::vector<FoundGaussian> leavesWithin(const GaussianMap<D>& map, const Vector<D>& point, double radius);

/// Searches for the nearest means of one scale of a map, or of its leaves. It is made for many queries.
///
/// The constructor copies the means and sorts them. This takes about as long as 1000 to 10,000 queries by the functions
/// above; each query is then two to five times as fast (`gaussmap_benchmark search`). The map may be changed or deleted
/// afterwards. Several threads can search at the same time. Copies are cheap. Distances can differ from those of the
/// functions above by rounding.
template <int D>
class GAUSSMAP_API MapSearch {
 public:
  /// Prepares the search of the leaves (see leaves()).
  explicit MapSearch(const GaussianMap<D>& map);
  /// Prepares the search of one scale. Throws std::out_of_range if the map does not have the scale.
  MapSearch(const GaussianMap<D>& map, int scale);

  /// Returns the number of means.
  std::size_t size() const;
  /// Returns the Gaussian whose mean is nearest to a point [m, map frame], or std::nullopt if there are no means. If
  /// several means are equally near, returns the one of the finest scale, and of these the one with the smallest index.
  /// Throws std::out_of_range if the point is not finite or out of the grid's range.
  std::optional<FoundGaussian> nearest(const Vector<D>& point) const;
  /// Returns the `k` Gaussians whose means are nearest to a point. Order and errors are those of nearestLeaves().
  std::vector<FoundGaussian> nearestK(const Vector<D>& point, int k) const;
  /// Returns the Gaussians whose means are at most `radius` [m] from a point. Order and errors are those of
  /// leavesWithin().
  std::vector<FoundGaussian> within(const Vector<D>& point, double radius) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

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
