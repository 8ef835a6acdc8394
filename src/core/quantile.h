// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace gaussmap::detail {

/// The value with `rank` smaller or equal ones before it in ascending order, rank in [0, n). Reorders the values.
template <typename T>
T nthSmallest(std::vector<T>& values, std::size_t rank) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Percentile by nearest rank: the smallest value that at least `percent` % of the values do not exceed, the
/// ceil(percent n / 100)-th. In integers, because 0.95 n rounds up to the next rank for some n. n >= 1. Reorders the
/// values.
template <typename T>
T percentile(std::vector<T>& values, std::size_t percent) {
  const std::size_t n = values.size();
  return nthSmallest(values, n / 100 * percent + (n % 100 * percent + 99) / 100 - 1);
}

}  // namespace gaussmap::detail
