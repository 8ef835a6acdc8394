// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mesh/triangle_mesh.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A set of distances, summarised in a few numbers [m]. Quantiles are by nearest rank: q95 is the ceil(0.95 n)-th
/// distance in ascending order.
struct DistanceSummary {
  double max = 0.0;       ///< largest distance
  double q99 = 0.0;       ///< 99 % quantile
  double q95 = 0.0;       ///< 95 % quantile
  double mean = 0.0;      ///< mean
  double rms = 0.0;       ///< root of the mean square
  std::size_t count = 0;  ///< number n of distances
};

/// Returns the summary of a set of distances. Throws std::invalid_argument if there are no distances.
GAUSSMAP_API DistanceSummary summarise(std::vector<double> distances);

/// The distances between two sets of points, in both directions.
struct HausdorffResult {
  DistanceSummary forward;   ///< from each point of a to the nearest point of b
  DistanceSummary backward;  ///< from each point of b to the nearest point of a
  /// Returns the Hausdorff distance [m]: the larger of the two maxima.
  double hausdorff() const { return forward.max > backward.max ? forward.max : backward.max; }
};

/// The distances of the single points, from which HausdorffResult is computed. In hausdorff(), `a` is the subject and
/// `b` is the reference. The points of planar maps and planar clouds have z = 0.
struct PointDistances {
  std::vector<Vector<3>> subject;  ///< points of the compared cloud, or samples of the compared map [m]
  std::vector<double> forward;     ///< per point of the subject: distance to the reference [m]
  std::vector<double> backward;    ///< per point of the reference, in its order: distance to the subject [m]
};

/// Computes the distances between two sets of points [m] in the same frame.
///
/// If `distances` is given, it receives the single distances. `threads`: 0 = all cores. Throws std::invalid_argument if
/// a set is empty or a point is not finite; the message gives the index of the point.
template <int D = 3>
GAUSSMAP_API HausdorffResult hausdorff(const std::vector<Vector<D>>& a, const std::vector<Vector<D>>& b,
                                       int threads = 0, PointDistances* distances = nullptr);

/// The two maxima of hausdorff().
struct HausdorffMaxima {
  double forward = 0.0;   ///< largest distance from a point of a to the nearest point of b [m]
  double backward = 0.0;  ///< largest distance from a point of b to the nearest point of a [m]
  /// Returns the Hausdorff distance [m]: the larger of the two.
  double hausdorff() const { return forward > backward ? forward : backward; }
};
/// Computes only the maxima of hausdorff(), with bit-identical results in less time.
///
/// Only a point whose distance can exceed the largest distance so far needs a search. Most points, and even whole boxes
/// of points, are excluded without one. Nearly all the time is spent on sorting the points. `threads`: 0 = all cores.
/// Throws like hausdorff().
template <int D = 3>
GAUSSMAP_API HausdorffMaxima hausdorffMaxima(const std::vector<Vector<D>>& a, const std::vector<Vector<D>>& b,
                                             int threads = 0);

/// The distances between a map and a reference. Forward is from the map's samples to the reference (surfaces that only
/// the map has); backward is from the reference to the samples (surfaces that the map misses).
struct MapHausdorff {
  HausdorffResult all;               ///< result for all samples
  HausdorffResult within_two_sigma;  ///< result for the samples within 2 sigma of their means; count = 0: none
  std::size_t gaussians = 0;         ///< number of compared Gaussians: those of the scale, or the leaves
  std::size_t samples = 0;           ///< number of samples of the map
  std::size_t unplaced = 0;          ///< number of samples for which no place was found, see sampleMap()
};

/// A reference for comparisons with maps and clouds. It is sorted once and serves any number of comparisons. It is a
/// plain value, and copies are cheap.
///
/// All comparisons take place in space. Planar points, samples and maps (D = 2) lie in the plane z = 0, so the
/// distances between them are those in the plane. They can also be compared with a reference in space, for example a
/// mesh.
class GAUSSMAP_API Reference {
 public:
  /// Makes a reference of points [m]. Throws std::invalid_argument if there are none or one is not finite; the message
  /// gives its index.
  template <int D = 3>
  explicit Reference(std::vector<Vector<D>> points);
  /// Makes a reference of the surface of a mesh.
  ///
  /// Forward distances are exact distances from the surface. Backward distances start from `samples` points on the
  /// surface (see sampleSurface()). Throws std::invalid_argument if the mesh has a fault or no area, or `samples` is 0.
  Reference(const TriangleMesh& mesh, std::size_t samples, std::uint64_t seed = 1);
  /// Makes a reference of the samples of another map. MapHausdorff::within_two_sigma then compares only the samples
  /// within 2 sigma of their means, in both maps. Throws std::invalid_argument if there are no samples.
  template <int D>
  explicit Reference(const MapSamples<D>& samples);

  /// Returns the points from which the backward distances start [m].
  const std::vector<Vector<3>>& points() const;

  /// Compares a cloud with the reference. If `distances` is given, it receives the single distances. Throws like
  /// hausdorff().
  template <int D = 3>
  HausdorffResult compare(const std::vector<Vector<D>>& subject, int threads = 0,
                          PointDistances* distances = nullptr) const;

  /// Compares samples of one scale of a map with the reference, Yguel 2009 sec. 6.
  ///
  /// The maximum of `all.forward` grows with the number of samples, as in the paper: more samples reach farther into
  /// the tails of the Gaussians. Therefore compare maps with equal options, or by q99, or by `within_two_sigma`, which
  /// leaves out the tails. If `distances` is given, it receives the single distances. Throws std::invalid_argument if
  /// the scale is empty, and std::out_of_range if the map does not have the scale.
  template <int D>
  MapHausdorff compare(const GaussianMap<D>& map, int scale, const SampleOptions& options = {},
                       PointDistances* distances = nullptr) const;
  /// Compares samples of the leaves of a map with the reference. Use it for a compressed map as a whole. It works like
  /// compare() for one scale, with the samples of sampleLeaves().
  template <int D>
  MapHausdorff compareLeaves(const GaussianMap<D>& map, const SampleOptions& options = {},
                             PointDistances* distances = nullptr) const;

 private:
  template <int D>
  MapHausdorff compareSamples(const MapSamples<D>& samples, int threads, PointDistances* distances) const;

  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

/// Compares one scale of a map with reference points [m, map frame]. Throws like Reference and Reference::compare().
template <int D>
GAUSSMAP_API MapHausdorff evaluateMap(const GaussianMap<D>& map, int scale, const std::vector<Vector<D>>& reference,
                                      const SampleOptions& options = {});

}  // namespace gaussmap
