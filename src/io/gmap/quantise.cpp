// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/quantise.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace gaussmap::detail {
namespace {

constexpr double kLowerStep = 1.0 / 32.0;  // relative to the diagonal of the row
constexpr double kMeanStep = 1.0 / 8.0;    // relative to the standard deviation with the other coordinates fixed
constexpr double kLogOddsStep = 1.0 / 16.0;
constexpr double kMaxLogOdds = 1e6;
constexpr double kMaxOffset = 0.501;       // of a mean from the cell's centre, in sides of the cell; as in GaussianMap
constexpr std::int64_t kWeightSteps = 16;  // steps from one power of two to the next
constexpr std::int64_t kMaxExponent = 1000;

constexpr std::int64_t kOctave = 16;
/// kPowers[k] = 2^(k / 16). kBetween[k] = 2^((k + 1/2) / 16), where the rounding changes from k to k + 1.
constexpr double kPowers[kOctave] = {1.0,
                                     1.0442737824274138,
                                     1.0905077326652577,
                                     1.1387886347566916,
                                     1.189207115002721,
                                     1.241857812073484,
                                     1.2968395546510096,
                                     1.3542555469368927,
                                     1.4142135623730951,
                                     1.4768261459394993,
                                     1.5422108254079407,
                                     1.6104903319492543,
                                     1.681792830507429,
                                     1.7562521603732995,
                                     1.8340080864093424,
                                     1.9152065613971474};
constexpr double kBetween[kOctave] = {1.0218971486541166, 1.0671404006768237, 1.1143867425958924, 1.1637248587775775,
                                      1.215247359980469,  1.2690509571917332, 1.3252366431597413, 1.383909881963832,
                                      1.4451808069770467, 1.5091644275934228, 1.5759808451078865, 1.645755478153965,
                                      1.718619298122478,  1.7947090750031072, 1.8741676341103,    1.9571441241754002};

/// Returns a positive number in steps of 1/16 octave, rounded.
std::int64_t sixteenths(double value) {
  int exponent = 0;
  const double mantissa = 2.0 * std::frexp(value, &exponent);  // [1, 2)
  const auto above = std::upper_bound(kBetween, kBetween + kOctave, mantissa) - kBetween;
  return kOctave * (exponent - 1) + above;
}

double fromSixteenths(std::int64_t number) {
  const std::int64_t octave = (number >= 0 ? number : number - (kOctave - 1)) / kOctave;
  if (std::abs(octave) > kMaxExponent) throw std::domain_error("a number is too large or too small");
  return std::ldexp(kPowers[number - octave * kOctave], static_cast<int>(octave));
}

std::int64_t wholeNumber(double value) {
  if (!(std::abs(value) < 0x1.0p62)) throw std::domain_error("numbers are too large or not finite");
  return static_cast<std::int64_t>(std::nearbyint(value));
}

template <int D>
using Factor = std::array<std::array<double, D>, D>;  // [row][column], lower

template <int D>
Factor<D> cholesky(const Matrix<D>& cov) {
  Factor<D> factor{};
  for (std::size_t column = 0; column < D; ++column)
    for (std::size_t row = column; row < D; ++row) {
      double rest = cov(static_cast<int>(row), static_cast<int>(column));
      for (std::size_t k = 0; k < column; ++k) rest -= factor[row][k] * factor[column][k];
      if (row == column && !(rest > 0.0 && std::isfinite(rest)))
        throw std::domain_error("a covariance is not positive definite");
      factor[row][column] = row == column ? std::sqrt(rest) : rest / factor[column][column];
    }
  return factor;
}

/// Returns the step of the mean along every axis.
template <int D>
Vector<D> meanSteps(const Factor<D>& factor) {
  Factor<D> inverse{};
  for (std::size_t column = 0; column < D; ++column) {
    inverse[column][column] = 1.0 / factor[column][column];
    for (std::size_t row = column + 1; row < D; ++row) {
      double sum = 0.0;
      for (std::size_t k = column; k < row; ++k) sum += factor[row][k] * inverse[k][column];
      inverse[row][column] = -sum / factor[row][row];
    }
  }
  Vector<D> steps;
  for (std::size_t axis = 0; axis < D; ++axis) {
    double precision = 0.0;  // (S~^-1)_ii
    for (std::size_t row = axis; row < D; ++row) precision += inverse[row][axis] * inverse[row][axis];
    steps(static_cast<int>(axis)) = kMeanStep / std::sqrt(precision);
  }
  return steps;
}

template <int D>
Factor<D> restoreFactor(const QuantisedGaussian<D>& numbers, double noise) {
  Factor<D> factor{};
  for (std::size_t i = 0; i < D; ++i) factor[i][i] = noise * fromSixteenths(numbers.diagonal[i]);
  std::size_t slot = 0;
  for (std::size_t column = 0; column < D; ++column)
    for (std::size_t row = column + 1; row < D; ++row)
      factor[row][column] = static_cast<double>(numbers.lower[slot++]) * (kLowerStep * factor[row][row]);
  return factor;
}

std::int64_t quantiseWeight(double weight) {
  if (!(weight > 0.0 && std::isfinite(weight))) throw std::domain_error("a weight is not positive or not finite");
  int exponent = 0;
  const double digits = std::nearbyint(std::frexp(weight, &exponent) * 2.0 * kWeightSteps);  // 16 ... 32
  return kWeightSteps * exponent + static_cast<std::int64_t>(digits) - kWeightSteps;
}

double restoreWeight(std::int64_t number) {
  const std::int64_t exponent = (number >= 0 ? number : number - (kWeightSteps - 1)) / kWeightSteps;
  if (std::abs(exponent) > kMaxExponent) throw std::domain_error("a weight is too large or too small");
  const std::int64_t digits = number - exponent * kWeightSteps + kWeightSteps;
  return std::ldexp(static_cast<double>(digits) / (2.0 * kWeightSteps), static_cast<int>(exponent));
}

}  // namespace

template <int D>
QuantisedGaussian<D> quantise(const Gaussian<D>& gaussian, double noise) {
  QuantisedGaussian<D> numbers;
  numbers.weight = quantiseWeight(gaussian.weight);
  const Factor<D> exact = cholesky<D>(gaussian.cov);
  Factor<D> error{};  // E
  for (std::size_t i = 0; i < D; ++i) {
    numbers.diagonal[i] = sixteenths(exact[i][i] / noise);
    error[i][i] = noise * fromSixteenths(numbers.diagonal[i]) / exact[i][i] - 1.0;
  }
  std::size_t slot = 0;
  for (std::size_t column = 0; column < D; ++column)
    for (std::size_t row = column + 1; row < D; ++row) {
      // L~_rc is the sum of L_rk (I + E)_kc for c <= k <= r. Without the term k = r, it is the value for which
      // E_rc = 0.
      double wanted = exact[row][column];
      for (std::size_t k = column; k < row; ++k) wanted += exact[row][k] * error[k][column];
      const double step = kLowerStep * (1.0 + error[row][row]) * exact[row][row];
      numbers.lower[slot] = wholeNumber(wanted / step);
      error[row][column] = (static_cast<double>(numbers.lower[slot++]) * step - wanted) / exact[row][row];
    }
  const Vector<D> steps = meanSteps<D>(restoreFactor<D>(numbers, noise));
  for (int axis = 0; axis < D; ++axis) {
    numbers.mean[static_cast<std::size_t>(axis)] = wholeNumber(gaussian.mean(axis) / steps(axis));
  }
  return numbers;
}

template <int D>
Gaussian<D> dequantise(const QuantisedGaussian<D>& numbers, double noise, double side) {
  const Factor<D> factor = restoreFactor<D>(numbers, noise);
  Gaussian<D> gaussian;
  gaussian.weight = restoreWeight(numbers.weight);
  for (int row = 0; row < D; ++row)
    for (int column = 0; column <= row; ++column) {
      double sum = 0.0;
      for (int k = 0; k <= column; ++k)
        sum += factor[std::size_t(row)][std::size_t(k)] * factor[std::size_t(column)][std::size_t(k)];
      gaussian.cov(row, column) = gaussian.cov(column, row) = sum;
    }
  const Vector<D> steps = meanSteps<D>(factor);
  for (int axis = 0; axis < D; ++axis) {
    const double offset = static_cast<double>(numbers.mean[static_cast<std::size_t>(axis)]) * steps(axis);
    gaussian.mean(axis) = std::clamp(offset, -kMaxOffset * side, kMaxOffset * side);
  }
  if (!gaussian.cov.allFinite() || !gaussian.mean.allFinite())
    throw std::domain_error("numbers are too large or too small");
  return gaussian;
}

std::int64_t quantiseLogOdds(float log_odds) {
  return wholeNumber(std::clamp(static_cast<double>(log_odds), -kMaxLogOdds, kMaxLogOdds) / kLogOddsStep);
}

float dequantiseLogOdds(std::int64_t number) {
  return static_cast<float>(static_cast<double>(number) * kLogOddsStep);
}

#define GAUSSMAP_INSTANTIATE(D)                                          \
  template QuantisedGaussian<D> quantise<D>(const Gaussian<D>&, double); \
  template Gaussian<D> dequantise<D>(const QuantisedGaussian<D>&, double, double);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
