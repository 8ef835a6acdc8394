// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "gaussmap/mapping/refine.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Throws std::invalid_argument, naming it, for a value that no map can have. MaxGaussians may name the scales from
/// `first_scale` on.
void checkBudget(const Budget& budget, int first_scale, int scales);
void checkSampling(const ErrorSampling& sampling);
/// The same for all that refine() is given.
GAUSSMAP_API void checkRefinement(const Budget& budget, const RefineOptions& options, int scales);
/// Throws std::invalid_argument for budgets that work for D = 3 only.
void refuseMeasuredBudget(const Budget& budget);

/// How many Gaussians PerCell or MaxGaussians allow a scale beyond one per cell; no more than `available` with PerCell.
/// `otherwise` = multiple of the cells at scales that MaxGaussians does not list. Throws std::invalid_argument if
/// MaxGaussians leaves a cell without a Gaussian.
GAUSSMAP_API std::size_t extraGaussians(const Budget& budget, int scale, std::size_t cells, std::size_t available,
                                        double otherwise = PerCell().gaussians);

/// Result of largestMultiple(): no multiple above 1 may fit, nor 1 itself; `bytes` tells.
struct FittingMultiple {
  double multiple = 1.0;
  double bytes = 0.0;
};
inline constexpr double kBytePrecision = 1.02;  // of the multiple

/// The largest multiple of the occupied cells, between 1 and `most`, whose map fits into max_bytes, to kBytePrecision.
/// bytesAt(1) is asked first.
FittingMultiple largestMultiple(double most, std::uintmax_t max_bytes,
                                const std::function<std::uintmax_t(double)>& bytesAt);

/// Throws std::invalid_argument if one Gaussian per cell takes more than max_bytes.
void requireRoom(std::uintmax_t max_bytes, std::uintmax_t one_per_cell);

}  // namespace gaussmap::detail
