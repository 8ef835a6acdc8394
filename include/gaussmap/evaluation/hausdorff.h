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

/// A set of distances in a few numbers [m]. Quantiles by nearest rank: q95 is the smallest of the distances that
/// at least 95 % of them do not exceed, the ceil(0.95 n)-th in ascending order.
struct DistanceSummary {
  double max = 0.0;
  double q99 = 0.0;
  double q95 = 0.0;
  double mean = 0.0;
  double rms = 0.0;
  std::size_t count = 0;  ///< n
};

/// Throws std::invalid_argument if there are no distances.
GAUSSMAP_API DistanceSummary summarise(std::vector<double> distances);

/// Distances between two sets of points, both directions apart.
struct HausdorffResult {
  DistanceSummary forward;   ///< from each point of a to its nearest of b
  DistanceSummary backward;  ///< from each point of b to its nearest of a
  /// The Hausdorff distance [m]: the larger of the two maxima.
  double hausdorff() const { return forward.max > backward.max ? forward.max : backward.max; }
};

/// The distances behind a result, one by one.
struct PointDistances {
  std::vector<Vector<3>> subject;  ///< n points [m]: the cloud that was compared, or the samples of the map
  std::vector<double> forward;     ///< n [m], of each of them to the reference
  std::vector<double> backward;    ///< [m], of each point of the reference, in its order, to the subject
};

/// Hausdorff distance of two sets of points [m], one frame. `threads` = 0: all; never shows in the result.
/// The single distances on request. Throws std::invalid_argument if a set is empty or a point is not finite (naming
/// its index).
GAUSSMAP_API HausdorffResult hausdorff(const std::vector<Vector<3>>& a, const std::vector<Vector<3>>& b,
                                       int threads = 0, PointDistances* distances = nullptr);

/// The maxima of hausdorff() alone, the same to the last bit. Most points are never searched for: they, or whole boxes
/// of them, are seen to have a neighbour nearer than the largest distance known already. Nearly all the time goes
/// into sorting.
struct HausdorffMaxima {
  double forward = 0.0;   ///< [m]
  double backward = 0.0;  ///< [m]
  double hausdorff() const { return forward > backward ? forward : backward; }
};
/// Throws as hausdorff().
GAUSSMAP_API HausdorffMaxima hausdorffMaxima(const std::vector<Vector<3>>& a, const std::vector<Vector<3>>& b,
                                             int threads = 0);

/// How far one scale of a map is from a reference; forward = from the map's samples to the reference (what the map
/// invents), backward = from the reference to the samples (what the map misses).
struct MapHausdorff {
  HausdorffResult all;               ///< all samples inside their bounds (SampleBounds)
  HausdorffResult within_two_sigma;  ///< only the samples at most 2 sigma from their means; count 0 if none is
  std::size_t gaussians = 0;         ///< of the scale, or leaves()
  std::size_t samples = 0;           ///< placed; `within_two_sigma.forward.count` of them are near their means
  std::size_t unplaced = 0;          ///< samples that found no place in their bounds, see sampleMap()
};

/// What maps and clouds are compared with, sorted once for any number of comparisons. A value; copies are cheap.
class GAUSSMAP_API Reference {
 public:
  /// Points [m]. Throws std::invalid_argument if there are none or one is not finite (naming its index).
  explicit Reference(std::vector<Vector<3>> points);
  /// The surface of a mesh: forward are the exact distances to it, backward those of `samples` points spread over its
  /// area (sampleSurface()). Throws std::invalid_argument if the mesh has a fault or no area, or samples is 0.
  Reference(const TriangleMesh& mesh, std::size_t samples, std::uint64_t seed = 1);
  /// Another map: its samples. `within_two_sigma` then looks at those near their means only, on both sides.
  /// Throws std::invalid_argument if there are none.
  explicit Reference(const MapSamples<3>& samples);

  /// What the backward distances start from [m].
  const std::vector<Vector<3>>& points() const;

  /// Compares a cloud. Throws as hausdorff().
  HausdorffResult compare(const std::vector<Vector<3>>& subject, int threads = 0,
                          PointDistances* distances = nullptr) const;

  /// Samples a scale of a map and compares the samples, Yguel 2009 sec. 6. Note what the maximum of `all.forward` is:
  /// a Gaussian has no end but its bounds', so it grows with the number of samples (the paper's Hausdorff distance does
  /// too). Compare maps at equal options, or by q99, or by `within_two_sigma`, whose samples fill an ellipsoid.
  /// Throws std::invalid_argument if the scale is empty, std::out_of_range for a scale that the map does not have.
  MapHausdorff compare(const GaussianMap<3>& map, int scale, const SampleOptions& options = {},
                       PointDistances* distances = nullptr) const;
  /// The same for the map at its finest, leaves(): a compressed map as a whole.
  MapHausdorff compareLeaves(const GaussianMap<3>& map, const SampleOptions& options = {},
                             PointDistances* distances = nullptr) const;

 private:
  MapHausdorff compareSamples(const MapSamples<3>& samples, int threads, PointDistances* distances) const;

  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

/// The same for one scale and reference points [m, map frame]. Throws as Reference and its compare().
GAUSSMAP_API MapHausdorff evaluateMap(const GaussianMap<3>& map, int scale, const std::vector<Vector<3>>& reference,
                                      const SampleOptions& options = {});

}  // namespace gaussmap
