// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace gaussmap::detail {

/// Where the largest gains end: all above `gain` are among them, and `ties` of those equal to it.
struct GainThreshold {
  double gain = 0.0;
  std::size_t ties = 0;
};

/// The `count` largest of numbers that do not all fit into memory: `visitAll(visit)` calls visit(number) for each of
/// them, and is called up to five times. With fewer than `count`, all are among them. Numbers are finite.
GainThreshold largestGains(std::size_t count, const std::function<void(const std::function<void(double)>&)>& visitAll);

}  // namespace gaussmap::detail
