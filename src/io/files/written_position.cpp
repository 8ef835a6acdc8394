// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/written_position.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "io/files/decimal.h"

namespace gaussmap::detail {
namespace {

constexpr double kFar = 1e3;      // [m]
constexpr double kCoarse = 0.01;  // [m], a tenth of a usual cell
constexpr int kExact = 99;        // digits of a number that no rounding wrote

/// A number as written.
struct Written {
  int digits = 0;  // significant digits
  int zeros = 0;   // of them at the end
  double step = 0.0;
  double value = 0.0;
};

Written writtenOf(std::string_view word) {
  const std::optional<Decimal> number = parseDecimal(word);
  if (!number) return {kExact, 0, 0.0, 0.0};
  const std::string digits = number->digits > 0 ? std::to_string(number->digits) : "";
  const std::size_t last = digits.find_last_not_of('0');
  Written written;
  written.digits = static_cast<int>(digits.size());
  written.zeros = last == std::string::npos ? 0 : static_cast<int>(digits.size() - last) - 1;
  written.step = std::pow(10.0, number->exponent);
  written.value = number->value();
  // "455123.0" has a fixed number of decimals, or is exact.
  if (number->exponent < 0 && written.zeros > 0 && word.find_first_of("eE") == std::string_view::npos)
    written.digits = kExact;
  return written;
}

}  // namespace

double stepOfRoundedPosition(const std::array<std::string_view, 3>& words) {
  double step = 0.0;
  for (const std::string_view word : words) {
    const Written number = writtenOf(word);
    if (number.digits > 7 && number.value != 0.0) return 0.0;
    const bool is_rounded = number.digits == 6 || number.digits == 7;
    if (is_rounded && number.digits - number.zeros >= 5 && std::abs(number.value) > kFar && number.step > 1.5 * kCoarse)
      step = std::max(step, number.step);
  }
  return step;
}

void RoundedPositions::add(double step, double x, double y, double z) {
  ++count_;
  if (!(step > 0.0)) return;
  ++rounded_;
  step_ = std::max(step_, step);
  largest_ = std::max({largest_, std::abs(x), std::abs(y), std::abs(z)});
}

std::string RoundedPositions::warning() const {
  if (rounded_ < 2 || 2 * rounded_ < count_) return "";
  const int digits = std::max(9, static_cast<int>(std::floor(std::log10(largest_))) + 3);
  std::ostringstream text;
  text << "the positions are rounded to steps of " << step_
       << " m, because they were written with too few digits; write at least " << digits;
  return text.str();
}

}  // namespace gaussmap::detail
