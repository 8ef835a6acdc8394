// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace gaussmap::detail {

/// Divides and rounds towards minus infinity, for divisors > 0: the parent of cell -1 is cell -1, not cell 0.
constexpr std::int64_t floorDivide(std::int64_t value, std::int64_t divisor) {
  return value / divisor - (value % divisor < 0 ? 1 : 0);
}

}  // namespace gaussmap::detail
