// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "gaussmap/mapping/refine.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Throws std::invalid_argument if a value of the budget is out of range; the message names the value. MaxGaussians may
/// list the scales from `first_scale` to `scales` - 1. MaxBytes must have the function for maps of these dimensions.
void checkBudget(const Budget& budget, int first_scale, int scales, int dimensions);
/// Throws std::invalid_argument if a number of samples is 0.
void checkSampling(const ErrorSampling& sampling);
/// Checks the budget and the options of refine() in the same way.
GAUSSMAP_API void checkRefinement(const Budget& budget, const RefineOptions& options, int scales, int dimensions);
/// Returns the size of a result [bytes], from the function of the budget for its dimension.
inline std::uintmax_t sizeOf(const MaxBytes& budget, const RefineResult<3>& result) {
  return budget.size_of(result);
}
inline std::uintmax_t sizeOf(const MaxBytes& budget, const RefineResult<2>& result) {
  return budget.planar_size_of(result);
}

/// Returns the number of Gaussians beyond one per cell that PerCell or MaxGaussians allows at a scale. If the limit is
/// a multiple of the cells, the scale gets at most `available` Gaussians. `otherwise` = the multiple at scales that
/// MaxGaussians does not list. Throws std::invalid_argument if MaxGaussians allows less than one Gaussian per cell.
GAUSSMAP_API std::size_t extraGaussians(const Budget& budget, int scale, std::size_t cells, std::size_t available,
                                        double otherwise = PerCell().gaussians);

/// Result of largestMultiple(). If no multiple fits, `multiple` is 1 and `bytes` exceeds the limit.
struct FittingMultiple {
  double multiple = 1.0;
  double bytes = 0.0;  ///< size of the map with this multiple
};
inline constexpr double kBytePrecision = 1.02;  // the multiple is found to within this factor

/// Returns the largest multiple of the occupied cells, between 1 and `most`, whose map fits into max_bytes. The result
/// is precise to kBytePrecision. bytesAt(multiple) returns the size of the map; bytesAt(1) is called first.
FittingMultiple largestMultiple(double most, std::uintmax_t max_bytes,
                                const std::function<std::uintmax_t(double)>& bytesAt);

/// Throws std::invalid_argument if one Gaussian per cell takes more than max_bytes.
void requireRoom(std::uintmax_t max_bytes, std::uintmax_t one_per_cell);

}  // namespace gaussmap::detail
