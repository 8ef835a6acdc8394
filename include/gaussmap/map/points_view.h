// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace gaussmap {

/// Points where they lie in somebody's records: x, y, z as floats one after the other [m], a record every `stride`
/// floats.
struct PointsView {
  const float* first = nullptr;
  std::size_t count = 0;
  std::size_t stride = 3;

  const float* operator[](std::size_t i) const { return first + i * stride; }
};

}  // namespace gaussmap
