// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Decides how many samples each Gaussian gets.
enum class SampleShare {
  /// Proportional to the volume of the Gaussian's ellipsoid, sqrt(det Sigma). All space that the map covers gets about
  /// equally dense samples, also where there were few points.
  Volume,
  /// Proportional to the weight of the Gaussian. The samples are as dense as the points were.
  Mass
};

/// Where the samples of a Gaussian may lie. Samples outside are rejected.
enum class SampleBounds {
  /// In the box around the finest cells that the Gaussian represents. The samples then extend at most one finest cell
  /// beyond the points of the Gaussian, although its tails are longer.
  MemberCells,
  /// In the cell of the Gaussian, as in the paper.
  Cell
};

/// Options of sampleMap(), sampleLeaves() and sampleCounts().
struct GAUSSMAP_API SampleOptions {
  std::size_t samples = 100000;  ///< total number, divided according to `share`; `at_least` can increase the total
  std::size_t at_least = 30;     ///< minimum number of samples per Gaussian
  SampleShare share = SampleShare::Volume;          ///< how many samples each Gaussian gets
  std::uint64_t seed = 1;                           ///< same map + same seed = bit-identical samples
  int threads = 0;                                  ///< 0 = all cores
  SampleBounds bounds = SampleBounds::MemberCells;  ///< where samples may lie

  /// Returns the options of the paper, Yguel 2009 sec. 6. The number of samples per Gaussian is proportional to the
  /// volume of its ellipsoid, without a minimum. Samples outside the cell of the Gaussian are rejected. The paper does
  /// not give the total number of samples; it is the default of `samples`.
  static SampleOptions yguel2009();
};

/// Samples of a map, in the order of their Gaussians. Each array has one entry per sample.
template <int D>
struct GAUSSMAP_API MapSamples {
  std::vector<Vector<D>> points;  ///< [m], map frame, each inside the bounds of its Gaussian
  /// The Gaussian of each sample. sampleMap(): its index in the scale; sampleLeaves(): its index in leaves().
  std::vector<std::uint32_t> gaussian;
  std::vector<double> mahalanobis;  ///< Mahalanobis distance of each sample from the mean of its Gaussian
  std::size_t unplaced = 0;         ///< number of missing samples, see sampleMap()

  /// Returns the points at a Mahalanobis distance of at most `sigmas`.
  std::vector<Vector<D>> within(double sigmas) const;
};

/// Returns the number of samples of each Gaussian of a scale: max(at_least, round(samples * share / sum of shares)).
///
/// Throws std::out_of_range if the map does not have the scale, and std::domain_error if a covariance is not positive
/// definite.
template <int D>
GAUSSMAP_API std::vector<std::size_t> sampleCounts(const GaussianMap<D>& map, int scale,
                                                   const SampleOptions& options = {});

/// Draws samples from the Gaussians of one scale, Yguel 2009 sec. 6.
///
/// Samples outside the bounds of their Gaussian are rejected (see SampleBounds; the paper uses SampleBounds::Cell). At
/// the finest scale, both kinds of bounds are the cell of the Gaussian. A Gaussian can have almost no mass inside its
/// bounds. Therefore there are at most 1000 + 200 k tries for k samples of a Gaussian. MapSamples::unplaced counts the
/// samples that are then missing.
///
/// The samples of a Gaussian depend on the Gaussian, the seed, the key of its cell, its rank in the cell and their
/// number. They do not depend on other cells of the map. Throws like sampleCounts().
template <int D>
GAUSSMAP_API MapSamples<D> sampleMap(const GaussianMap<D>& map, int scale, const SampleOptions& options = {});

/// Draws samples from the Gaussians of leaves(). The leaves of all scales share SampleOptions::samples.
///
/// The samples of a Gaussian lie in its cell; SampleOptions::bounds is not used. The number of tries is limited as in
/// sampleMap(). Throws std::domain_error if a covariance is not positive definite.
template <int D>
GAUSSMAP_API MapSamples<D> sampleLeaves(const GaussianMap<D>& map, const SampleOptions& options = {});

}  // namespace gaussmap
