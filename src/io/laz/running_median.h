// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace gaussmap::detail {

/// Approximates the median of the last values. A new value replaces the largest or the smallest of five sorted values,
/// so that those values surround the new ones.
class RunningMedian {
 public:
  std::int32_t get() const { return sorted_[2]; }

  void add(std::int32_t value) {
    const auto [a, b, c, d, e] = sorted_;
    if (replace_largest_) {
      sorted_ = {std::min(value, a), std::max(a, std::min(value, b)), std::max(b, std::min(value, c)),
                 std::max(c, std::min(value, d)), std::max(d, value)};
      replace_largest_ = value < c;
    } else {
      sorted_ = {std::min(b, value), std::min(c, std::max(value, b)), std::min(d, std::max(value, c)),
                 std::min(e, std::max(value, d)), std::max(value, e)};
      replace_largest_ = value <= c;
    }
  }

 private:
  std::array<std::int32_t, 5> sorted_{};
  bool replace_largest_ = true;
};

}  // namespace gaussmap::detail
