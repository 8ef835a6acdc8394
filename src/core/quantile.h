// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace gaussmap::detail {

/// Returns the value at index `rank` in ascending order, rank in [0, n). Reorders the values.
template <typename T>
T nthSmallest(std::vector<T>& values, std::size_t rank) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Returns the median of the steps between the different values, in ascending order; std::nullopt if all values are
/// equal.
template <typename T>
std::optional<T> medianStep(std::vector<T> values) {
  std::sort(values.begin(), values.end());
  std::vector<T> steps;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] != values[i - 1]) steps.push_back(values[i] - values[i - 1]);
  if (steps.empty()) return std::nullopt;
  return nthSmallest(steps, steps.size() / 2);
}

/// Returns the percentile by nearest rank: the smallest value that is greater than or equal to at least `percent` % of
/// the values, which is the ceil(percent n / 100)-th. It is computed in integers, because in doubles 0.95 n rounds up
/// to the next rank for some n. n >= 1. Reorders the values.
template <typename T>
T percentile(std::vector<T>& values, std::size_t percent) {
  const std::size_t n = values.size();
  return nthSmallest(values, n / 100 * percent + (n % 100 * percent + 99) / 100 - 1);
}

}  // namespace gaussmap::detail
