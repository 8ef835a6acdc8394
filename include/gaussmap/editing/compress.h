// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct CompressOptions {
  std::size_t samples = 100;  ///< of every Gaussian that is tested, >= 1
  std::uint64_t seed = 1;     ///< of these; same map + same seed = same bytes, at any number of threads
  int threads = 0;            ///< 0 = all
};

/// Deletes detail where it is not needed, Yguel 2009 sec. 5.4: from the coarsest scale down, everything finer under a
/// coarse cell goes if the cell's own Gaussians are good enough; else its children are looked at. What stays, stays as
/// it was to the last bit; a map of which nothing can go comes back as it is. See leaves() for what then stands where.
///
/// Good enough, both ways, with the means of the finest Gaussians of the given map as the data:
/// - what the cell says is there: of each of its Gaussians at least 95 % of the samples (`samples` of them, inside the
///   cell) lie within max_error [m] of a datum, wherever that is;
/// - what is there, the cell says: every datum under it lies within max_error of the ellipsoid that holds 95 % of the
///   mass of one of its Gaussians (0 inside: a Gaussian too fat for its data fails by its samples).
///
/// So this holds for the result: of sampleMap()'s samples of each Gaussian in a coarse cell that stands alone
/// ({samples = 0, at_least = options.samples, seed, bounds = Cell}) at least 95 % are within max_error of the old data,
/// of all of these together hence too; and no old datum is farther than max_error from the 95 % ellipsoids of the
/// Gaussians that stand for it now. Other samples show the same up to chance. Neighbouring data are as far apart as
/// finest cells: a max_error below half their side deletes next to nothing. Throws std::invalid_argument unless
/// max_error is a positive number of metres and samples > 0, and if the map is compressed already: what was deleted is
/// not there to measure against.
GAUSSMAP_API GaussianMap<3> compress(GaussianMap<3> map, double max_error, const CompressOptions& options = {});

}  // namespace gaussmap
