// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>

namespace gaussmap::detail {

/// How well moving objects were removed from scans, measured with points whose truth is known.
struct RemovalScore {
  std::size_t still = 0, still_kept = 0;
  std::size_t moving = 0, moving_removed = 0;

  void add(bool is_moving, bool removed) {
    still += !is_moving;
    still_kept += !is_moving && !removed;
    moving += is_moving;
    moving_removed += is_moving && removed;
  }

  /// SA, share of the still points that were kept; 1 if there are none.
  double staticAccuracy() const {
    return still == 0 ? 1.0 : static_cast<double>(still_kept) / static_cast<double>(still);
  }
  /// DA, share of the moving points that were removed; 1 if there are none.
  double dynamicAccuracy() const {
    return moving == 0 ? 1.0 : static_cast<double>(moving_removed) / static_cast<double>(moving);
  }
  /// AA, the geometric mean of both.
  double associatedAccuracy() const { return std::sqrt(staticAccuracy() * dynamicAccuracy()); }
};

}  // namespace gaussmap::detail
