// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What the number of samples of a Gaussian is proportional to.
enum class SampleShare {
  Volume,  ///< of its ellipsoid, sqrt(det Sigma): every place the map claims is looked at, however few points it had
  Mass     ///< its weight: samples stand as dense as the points did
};

/// Where the samples of a Gaussian may lie; others are rejected.
enum class SampleBounds {
  MemberCells,  ///< in the box of the finest cells that it stands for, memberBoxes(): its tails end with its object
  Cell          ///< in its cell, as in the paper
};

struct SampleOptions {
  std::size_t samples = 100000;  ///< shared out by `share`; the minimum below comes on top where it acts
  std::size_t at_least = 30;     ///< for every Gaussian
  SampleShare share = SampleShare::Volume;
  std::uint64_t seed = 1;  ///< same map + same seed = same samples, to the last bit
  int threads = 0;         ///< 0 = all; never shows in the result
  SampleBounds bounds = SampleBounds::MemberCells;
};

/// Samples in the order of the map: by cell, then by Gaussian.
template <int D>
struct GAUSSMAP_API MapSamples {
  std::vector<Vector<D>> points;        ///< n [m], map frame, each inside the bounds of its Gaussian
  std::vector<std::uint32_t> gaussian;  ///< n, index of the sample's Gaussian in the scale (or in leaves())
  std::vector<double> mahalanobis;      ///< n, distance to its Gaussian's mean in standard deviations
  std::size_t unplaced = 0;             ///< asked for, but not found inside the bounds (see sampleMap)

  /// The points at most `sigmas` standard deviations from their means: a filter of the same samples.
  std::vector<Vector<D>> within(double sigmas) const;
};

/// How many samples each Gaussian of a scale gets: max(at_least, round(samples * share / sum of shares)).
/// Throws std::out_of_range for a scale the map does not have, std::domain_error if a covariance is not positive
/// definite.
template <int D>
GAUSSMAP_API std::vector<std::size_t> sampleCounts(const GaussianMap<D>& map, int scale,
                                                   const SampleOptions& options = {});

/// Samples of the Gaussians of one scale, those outside their Gaussian's bounds rejected, Yguel 2009 sec. 6 (there: its
/// cell). At the finest scale both kinds of bounds are the cells.
/// A Gaussian with (almost) no mass in its bounds is given up after 1000 + 200 n tries for n samples; what was not
/// placed by then is counted in `unplaced`. A Gaussian's samples depend on the seed, its cell's key, its rank in
/// the cell and their number, not on where it stands in the map. Throws as sampleCounts().
template <int D>
GAUSSMAP_API MapSamples<D> sampleMap(const GaussianMap<D>& map, int scale, const SampleOptions& options = {});

/// The same for the map at its finest, leaves(): of a compressed map the samples of all scales together. Coarse
/// Gaussians without detail under them are bounded by their cells.
template <int D>
GAUSSMAP_API MapSamples<D> sampleLeaves(const GaussianMap<D>& map, const SampleOptions& options = {});

}  // namespace gaussmap
