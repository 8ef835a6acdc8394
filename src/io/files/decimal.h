// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "gaussmap/version.h"

namespace gaussmap::detail {

/// A decimal number as written: digits * 10^exponent. Digits behind the 19th are dropped.
struct Decimal {
  std::uint64_t digits = 0;
  int exponent = 0;
  bool negative = false;
  bool whole = false;  ///< written with digits only

  /// Returns the nearest double.
  GAUSSMAP_API double value() const;
};

/// Returns nullopt if the word is not a finite decimal number.
GAUSSMAP_API std::optional<Decimal> parseDecimal(std::string_view word);

}  // namespace gaussmap::detail
