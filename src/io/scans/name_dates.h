// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/scans/time_text.h"

namespace gaussmap::detail {

/// A run of digits in a name.
struct DigitRun {
  std::string_view digits;
  char before = 0;  ///< the character between this run and the one before it; 0 if there is not exactly one
};

/// The dates in the names of scans.
struct NameDates {
  std::vector<Decimal> times;  ///< one per name: seconds since 1970, read as UTC
  std::size_t first = 0;       ///< the first run of digits of the dates, counted from the end of the name
  std::size_t runs = 0;        ///< how many runs the dates have
};

/// Finds dates with a time of day such as 2023-11-14_22-13-20, 20231114T221320.5 and 20231114_221320_500 at the same
/// place of all names. Each row has the runs of digits of a name, from its end to its start, and at least `runs`.
/// Returns nullopt if the names have no dates.
std::optional<NameDates> datesIn(const std::vector<std::vector<DigitRun>>& rows, std::size_t runs);

}  // namespace gaussmap::detail
