// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace gaussmap {

/// A handful of points, one array an axis: what readers fill and what MomentGrid counts. Small enough to
/// stay in the first-level cache, so that a scan is never copied as a whole.
template <int D>
struct PointBlock {
  static constexpr std::size_t kCapacity = 512;
  std::size_t size = 0;
  alignas(64) double coordinate[D][kCapacity];  ///< [m]
};

}  // namespace gaussmap
