// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of compress().
struct CompressOptions {
  std::size_t samples = 100;  ///< per tested Gaussian, >= 1
  std::uint64_t seed = 1;     ///< same map + same seed = bit-identical result
  int threads = 0;            ///< 0 = all cores
};

/// Deletes detail where the coarser cells are good enough, Yguel 2009 sec. 5.4.
///
/// The function works from the coarsest scale down. If the Gaussians of a coarse cell are good enough, everything below
/// this cell is deleted. Otherwise its children are tested. Cells that are kept do not change. If nothing can be
/// deleted, the map is returned unchanged. See leaves() for the result.
///
/// The reference is the means of the finest Gaussians of the given map. A cell is good enough if both criteria hold:
/// - For each of its Gaussians, at least 95 % of the samples inside the cell lie within max_error [m] of a reference
///   mean, in this cell or another. There are `samples` samples per Gaussian.
/// - Every reference mean below the cell lies within max_error of the 95 % ellipsoid of one of its Gaussians. The
///   distance is 0 inside the ellipsoid; an ellipsoid that is too wide fails the first criterion.
///
/// The result therefore has two properties:
/// - At least 95 % of the samples of each Gaussian in a coarse leaf cell lie within max_error of a reference mean. This
///   holds exactly for sampleMap() with `samples` = 0, `at_least` = CompressOptions::samples, the same seed and
///   SampleBounds::Cell. For other samples it holds with random deviations.
/// - Every reference mean lies within max_error of the 95 % ellipsoid of a Gaussian that now represents it.
///
/// Adjacent reference means are about one finest cell apart. A max_error below half the side of a finest cell therefore
/// deletes almost nothing. Throws std::invalid_argument if max_error is not positive and finite or `samples` is 0. Also
/// throws it if the map is already compressed, because the deleted detail is missing as a reference.
GAUSSMAP_API GaussianMap<3> compress(GaussianMap<3> map, double max_error, const CompressOptions& options = {});

}  // namespace gaussmap
