// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of compress().
struct CompressOptions {
  std::size_t samples = 100;  ///< number of samples per tested Gaussian, >= 1
  std::uint64_t seed = 1;     ///< same map + same seed = bit-identical result
  int threads = 0;            ///< 0 = all cores
};

/// Deletes detail where the coarser cells are good enough, Yguel 2009 sec. 5.4.
///
/// The function works from the coarsest scale down. If the Gaussians of a coarse cell are good enough, everything below
/// this cell is deleted. Otherwise its children are tested. Cells that are kept do not change. If nothing can be
/// deleted, the map is returned unchanged. In the result, the Gaussians of leaves() represent the whole map.
///
/// The reference is the means of the finest Gaussians of the given map. A cell is good enough if both criteria hold:
/// - Each of its Gaussians gets `samples` samples inside the cell. At least 95 % of them lie within max_error [m] of
///   the nearest reference mean. This mean can be in another cell. A Gaussian for which no sample is found fails.
/// - Every reference mean below the cell lies within max_error of the 95 % ellipsoid of one of its Gaussians. This
///   ellipsoid contains 95 % of the probability mass; inside it the distance is 0. An ellipsoid that is too wide passes
///   this criterion but fails the first one.
///
/// The result therefore has two properties:
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
