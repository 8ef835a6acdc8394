// SPDX-License-Identifier: BSD-3-Clause
// header only
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

/// Points where they lie in somebody's records: x, y, z as floats one after the other [m], a record every `stride`
/// floats.
struct PointsView {
  const float* first = nullptr;
  std::size_t count = 0;
  std::size_t stride = 3;

  const float* operator[](std::size_t i) const { return first + i * stride; }
};

}  // namespace gaussmap
