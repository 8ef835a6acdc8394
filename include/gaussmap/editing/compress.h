// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The criterion by which compress() decides that a coarse cell is good enough.
enum class CompressBy {
  /// The distances between the Gaussians of the cell and the means of the finest scale.
  Distance,
  /// The error of the cell, Yguel 2009 eq. (6), as in the paper: the mean squared Mahalanobis distance from a Gaussian
  /// of the next finer scale to the nearest cluster.
  CellError,
};

/// Options of compress().
struct GAUSSMAP_API CompressOptions {
  std::size_t samples = 100;             ///< CompressBy::Distance: number of samples per tested Gaussian, >= 1
  std::uint64_t seed = 1;                ///< CompressBy::Distance: same map + same seed = bit-identical result
  int threads = 0;                       ///< 0 = all cores
  CompressBy by = CompressBy::Distance;  ///< criterion for a cell that is good enough
  /// CompressBy::CellError: multiplies the terms of eq. (6) by 1 - eps, see RefineOptions::learning_factor.
  bool learning_factor = false;

  /// Returns the options of the paper, Yguel 2009: CompressBy::CellError with the factor 1 - eps.
  static CompressOptions yguel2009();
};

/// Deletes detail where the coarser cells are good enough. Yguel 2009 proposes this in the abstract and in sec. 1.
///
/// The function works from the coarsest scale down. If the Gaussians of a coarse cell are good enough, everything below
/// this cell is deleted. Otherwise its children are tested. Cells that are kept do not change. If nothing can be
/// deleted, the map is returned unchanged. In the result, the Gaussians of leaves() represent the whole map.
///
/// CompressBy::CellError: `max_error` has no unit: eq. (6) is a squared number of standard deviations of the finer
/// Gaussians. A cell is good enough if the error of this cell, and the error of every coarse cell below it, is at most
/// max_error. The paper gives neither a value of the limit nor a rule for the cells below. This criterion uses no
/// random numbers.
///
/// CompressBy::Distance: `max_error` is in metres. The reference is the means of the finest Gaussians of the given map.
/// A cell is good enough if both criteria hold:
/// - Each of its Gaussians gets `samples` samples inside the cell. At least 95 % of them lie within max_error [m] of
///   the nearest reference mean. This mean can be in another cell. A Gaussian for which no sample is found fails.
/// - Every reference mean below the cell lies within max_error of the 95 % ellipsoid of one of its Gaussians. This
///   ellipsoid contains 95 % of the probability mass; inside it the distance is 0. An ellipsoid that is too wide passes
///   this criterion but fails the first one.
///
/// The result of CompressBy::Distance therefore has two properties:
/// - At least 95 % of the samples of each Gaussian in a coarse leaf cell lie within max_error of a reference mean. This
///   is exact for the samples that were tested. sampleMap() draws the same samples with `samples` = 0, `at_least` =
///   CompressOptions::samples, the same seed and SampleBounds::Cell. For other samples the share can differ a little.
/// - Every reference mean lies within max_error of the 95 % ellipsoid of a Gaussian that now represents it.
///
/// Adjacent reference means are about one finest cell apart. A max_error below half the side of a finest cell therefore
/// deletes almost nothing. Throws std::invalid_argument if max_error is not positive and finite, if `samples` is 0, or
/// if the map is already compressed. A compressed map does not have all the reference means any more.
template <int D>
GAUSSMAP_API GaussianMap<D> compress(GaussianMap<D> map, double max_error, const CompressOptions& options = {});

}  // namespace gaussmap
