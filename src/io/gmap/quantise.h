// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// A Gaussian in whole numbers, as a final map stores it.
///
/// The covariance is S = L L' with the lower Cholesky factor L. With the decoded factor L~, let E = L^-1 L~ - I. Then
/// the standard deviation in every direction changes by a factor between 1 - |E| and 1 + |E|.
///
/// The diagonal of L is stored in steps of 1/16 octave, which are factors of 2^(1/16), so |E_ii| < 0.022. Each number
/// below the diagonal is first corrected for the errors of the numbers before it, and then stored in steps of 1/32 of
/// the diagonal of its row, so |E_ij| < 0.016. Together, |E| < 0.05. L~ L~' is positive definite for any numbers.
///
/// The mean along axis i is stored in steps of 1/8 of 1 / sqrt((S~^-1)_ii). This is the standard deviation along the
/// axis if the other coordinates are fixed. The weight has five binary digits: it is exact up to 32; a larger weight
/// changes by at most 1/32 of its value.
template <int D>
struct QuantisedGaussian {
  static constexpr std::size_t kLower = D * (D - 1) / 2;
  std::int64_t weight = 0;
  std::array<std::int64_t, D> mean{};
  std::array<std::int64_t, D> diagonal{};
  std::array<std::int64_t, kLower> lower{};  ///< column by column
};

/// Rounds a Gaussian to whole numbers. `noise` is the noise floor [m], which is the unit of the factor. The function
/// uses no logarithm and no exponential, so the numbers are the same on every machine. Throws std::domain_error if the
/// covariance is not positive definite or the weight is not positive.
template <int D>
QuantisedGaussian<D> quantise(const Gaussian<D>& gaussian, double noise);

/// Returns the Gaussian of these numbers. `noise` is that of quantise(), `side` is the side of the cell [m]. The mean
/// is clamped to the cell. Throws std::domain_error if doubles cannot hold the Gaussian.
template <int D>
Gaussian<D> dequantise(const QuantisedGaussian<D>& numbers, double noise, double side);

/// Log-odds in steps of 1/16, clamped to +-1e6.
std::int64_t quantiseLogOdds(float log_odds);
float dequantiseLogOdds(std::int64_t number);

}  // namespace gaussmap::detail
