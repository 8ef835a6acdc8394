// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace gaussmap::detail {

/// Threshold of the largest gains: they are all gains above `gain`, and `ties` gains that are equal to it.
struct GainThreshold {
  double gain = 0.0;
  std::size_t ties = 0;
};

/// Returns the threshold of the `count` largest gains. The gains need not fit into memory: `visitAll(visit)` calls
/// visit(gain) for each of them, and is called up to four times. If there are fewer than `count` gains, all of them are
/// above the threshold. All gains must be finite.
GainThreshold largestGains(std::size_t count, const std::function<void(const std::function<void(double)>&)>& visitAll);

}  // namespace gaussmap::detail
