// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// A Gaussian in whole numbers: what a final map keeps of it.
///
/// The covariance is S = L L', L its lower Cholesky factor. With E = L^-1 L~ - I for the factor L~ that comes back, the
/// standard deviation in every direction is right but for a factor in 1 +- |E|. The diagonal of L is kept in sixteenths
/// of an octave, so that |E_ii| < 0.022; each number beside it in thirty-seconds of the diagonal of its row, once it
/// is corrected for the errors before it, so that |E_ij| < 0.016; together |E| < 0.05. Whatever the
/// numbers, L~ L~' is positive definite.
/// The mean is kept in eighths of 1 / sqrt((S~^-1)_ii) along axis i: the standard deviation there with the other
/// coordinates fixed. The weight has five binary digits: exact up to 32, then right to 1 / 32.
template <int D>
struct QuantisedGaussian {
  static constexpr std::size_t kLower = D * (D - 1) / 2;
  std::int64_t weight = 0;
  std::array<std::int64_t, D> mean{};
  std::array<std::int64_t, D> diagonal{};
  std::array<std::int64_t, kLower> lower{};  ///< column by column
};

/// `noise` = noise floor, unit of the factor; `side` = of the cell [m]. No logarithm, no exponential: the same numbers
/// on every machine. Throws std::domain_error if the covariance is not positive definite or the weight not positive.
template <int D>
QuantisedGaussian<D> quantise(const Gaussian<D>& gaussian, double noise);

/// The Gaussian that comes back; the mean is kept within the cell. Throws std::domain_error if the numbers stand for
/// none that doubles can hold.
template <int D>
Gaussian<D> dequantise(const QuantisedGaussian<D>& numbers, double noise, double side);

/// Log-odds in sixteenths; beyond +-1e6 they are cut.
std::int64_t quantiseLogOdds(float log_odds);
float dequantiseLogOdds(std::int64_t number);

}  // namespace gaussmap::detail
