// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <variant>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

/// How far samples of a scale lie from the data if it has so many Gaussians [m]. The data are samples of the finest
/// scale, as dense as its points were: errors below about half a finest cell mean nothing.
struct ErrorPoint {
  std::size_t gaussians = 0;
  double q99 = 0.0;
  double q95 = 0.0;
  double mean = 0.0;
};

/// What other budgets would give at one scale.
struct ErrorCurve {
  int scale = 1;
  std::vector<ErrorPoint> points;  ///< at rising numbers of Gaussians; the first is one per cell
};

/// From which samples errors are measured.
struct ErrorSampling {
  std::size_t samples = 20000;  ///< of a scale, by volume, >= 1
  std::size_t data = 200000;    ///< of the finest scale, by weight, >= 1
  std::uint64_t seed = 1;
};

/// Which points of the error curves are measured.
struct CurveOptions {
  std::vector<double> multiples = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};  ///< of the scale's cells, rising, >= 1
  ErrorSampling sampling;  ///< with MaxError, its sampling is used for the curves too
};

/// A scale that cannot be brought below the error of MaxError.
struct NotReached {
  int scale = 1;
  double q95 = 0.0;  ///< the least that the finer scale's Gaussians allow; simplify(): the error that it has [m]
};

/// What refine() and simplify() return.
template <int D>
struct RefineResult {
  GaussianMap<D> map;
  std::vector<ErrorCurve> curves;       ///< scales 1, 2, ... if RefineOptions::curves asks for them
  std::vector<NotReached> not_reached;  ///< MaxError only
};

/// At most so many Gaussians per scale, as a multiple of its occupied cells.
struct PerCell {
  double gaussians = 3.0;  ///< >= 1; 1: one per cell
};

/// At most so many Gaussians per scale. For scales that are not listed, refine() uses PerCell{}; simplify() leaves them
/// as they are.
struct MaxGaussians {
  std::map<int, std::size_t> by_scale;  ///< not less than the scale has cells
};

/// The largest multiple of the occupied cells whose map is not larger than a number of bytes, to 2 %. D = 3 only.
struct MaxBytes {
  std::uintmax_t bytes = 0;
  /// Measures a result, for example maxFileBytes() the size of its map file. Required. While budgets are tried out the
  /// curves are placeholders that are longer in decimals than true ones.
  std::function<std::uintmax_t(const RefineResult<3>&)> size_of;
};

/// As few Gaussians per scale as keep the 95 % quantile of ErrorPoint at this distance or below. D = 3 only.
struct MaxError {
  double metres = 0.0;  ///< > 0 [m]
  ErrorSampling sampling;
};

/// The limit of a refinement or simplification.
using Budget = std::variant<PerCell, MaxGaussians, MaxBytes, MaxError>;

}  // namespace gaussmap
