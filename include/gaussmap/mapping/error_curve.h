// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/refine.h"

namespace gaussmap {

/// How far samples of a scale lie from the data when it has so many Gaussians [m]. The data are samples of the finest
/// scale, as dense as its points were: errors below about half a finest cell mean nothing.
struct ErrorPoint {
  std::size_t gaussians = 0;
  double q99 = 0.0;
  double q95 = 0.0;
  double mean = 0.0;
};

struct ErrorCurve {
  int scale = 1;
  std::vector<ErrorPoint> points;  ///< at rising numbers of Gaussians, the first is one per cell
};

struct RefinedMap {
  GaussianMap<3> map;
  std::vector<ErrorCurve> curves;  ///< of the scales 1, 2, ...; empty where there is nothing to refine
};

struct CurveOptions {
  std::vector<double> multiples = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};  ///< of the scale's cells, rising
  std::size_t samples = 20000;                                          ///< of a scale, by volume
  std::size_t data = 200000;                                            ///< samples of the finest scale, by weight
  std::uint64_t seed = 1;
};

/// refine() by agglomeration, and what other budgets would have given: one dendrogram serves them all. The curve of a
/// scale is that over the finer scale as it was refined. Throws as refine().
RefinedMap refineWithCurves(GaussianMap<3> map, const RefineOptions& options, const CurveOptions& curve = {});

/// A scale that could not be brought below the error.
struct ErrorNotReached {
  int scale = 1;
  double q95 = 0.0;  ///< the least that the finer scale's Gaussians allow [m]
};

struct RefinedToError {
  RefinedMap refined;
  std::vector<ErrorNotReached> not_reached;  ///< these scales have as many Gaussians as the finer one
};

/// As few Gaussians at each coarse scale as bring the 95 % quantile of ErrorPoint to max_error [m] or below, found by
/// bisection over one dendrogram. options.budget and max_gaussians are not used.
/// Throws std::invalid_argument unless max_error > 0, and as refine().
RefinedToError refineToError(GaussianMap<3> map, double max_error, const RefineOptions& options,
                             const CurveOptions& curve = {});

/// The largest budget whose map is at most `max_bytes` large by `bytesOf`, with its curves. Throws
/// std::invalid_argument, naming the bytes it takes, if one Gaussian per cell is too much already; and as refine().
RefinedMap refineToBytes(const GaussianMap<3>& map, std::uintmax_t max_bytes,
                         const std::function<std::uintmax_t(const RefinedMap&)>& bytesOf, const RefineOptions& options,
                         const CurveOptions& curve = {});

}  // namespace gaussmap
