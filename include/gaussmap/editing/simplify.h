// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/error_curve.h"

namespace gaussmap {

struct SimplifyOptions {
  std::optional<double> budget;              ///< most Gaussians of a scale, as a multiple of its occupied cells, >= 1
  std::map<int, std::size_t> max_gaussians;  ///< most Gaussians of a scale, by scale, in place of the budget
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair of clusters is merged next
  int threads = 0;                           ///< 0 = all; never shows in the result
};

/// Fewer Gaussians, Yguel 2009 sec. 5.4: clusters of a cell are merged where it costs least, summed over the scale,
/// until there are as few as asked for. No finer scale is needed, whatever the map still has: compressed and final
/// maps, maps of one scale. What is linked to merged clusters is linked to their union, so that coarse clusters stay
/// the moment matches of what they stand for. A cell keeps one Gaussian at least; exact moments stay.
/// Throws std::invalid_argument, naming the option, for a budget below 1, a scale that the map does not have, or fewer
/// Gaussians than a scale has cells.
template <int D>
GaussianMap<D> simplify(GaussianMap<D> map, const SimplifyOptions& options);

struct SimplifiedToError {
  GaussianMap<3> map;
  std::vector<ErrorNotReached> not_reached;  ///< scales that were farther away as they came: they stay
};

/// As few Gaussians at each scale as keep the 95 % quantile of the distances from samples of the scale to those of the
/// finest that the given map has (leaves()) at max_error [m] or below; by bisection. options.budget and max_gaussians
/// are not used. Throws std::invalid_argument unless max_error > 0.
SimplifiedToError simplifyToError(GaussianMap<3> map, double max_error, const SimplifyOptions& options,
                                  const CurveOptions& measure = {});

/// The largest budget whose map is at most max_bytes large by `bytesOf`, to 2 %. Throws std::invalid_argument, naming
/// the bytes it takes, if one Gaussian per cell is too much already.
GaussianMap<3> simplifyToBytes(const GaussianMap<3>& map, std::uintmax_t max_bytes,
                               const std::function<std::uintmax_t(const GaussianMap<3>&)>& bytesOf,
                               const SimplifyOptions& options);

}  // namespace gaussmap
