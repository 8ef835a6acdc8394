// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace gaussmap::detail {

/// Maximum distance of a search for cells [cells]. The time of a search grows with the cube of the distance.
constexpr double kMaxCells = 1000.0;

/// Returns a distance [m] in cells, rounded, at least 1. The distance must be at most kMaxCells cells.
inline std::int32_t cellsFor(double distance, double resolution) {
  return static_cast<std::int32_t>(std::fmax(1.0, std::round(distance / resolution)));
}

/// Calls body(key) for the 3^N keys that differ from `key` by at most one cell on every axis, including `key`. The
/// first axis varies fastest. Keys beyond 32 bits are skipped.
template <std::size_t N, typename Body>
void forKeysAround(const std::array<std::int32_t, N>& key, const Body& body) {
  std::array<std::int32_t, N> near = key;
  const auto step = [&](const auto& self, std::size_t axis) -> void {
    for (std::int32_t by = -1; by <= 1; ++by) {
      if (__builtin_add_overflow(key[axis], by, &near[axis])) continue;
      if (axis == 0)
        body(near);
      else
        self(self, axis - 1);
    }
  };
  step(step, N - 1);
}

/// Calls body(key) for all keys at a distance of `from` to `to` cells from `key`; 1 <= from <= to. The distance is the
/// largest difference on an axis. Keys beyond 32 bits are skipped.
template <std::size_t N, typename Body>
void forNearKeys(const std::array<std::int32_t, N>& key, std::int32_t from, std::int32_t to, const Body& body) {
  std::array<std::int32_t, N> near = key;
  const auto step = [&](const auto& self, std::size_t axis, bool inside) -> void {
    for (std::int32_t by = -to; by <= to; ++by) {
      const bool still_inside = inside && std::abs(by) < from;
      if (axis + 1 == N && still_inside) by = from;  // skips the keys that are too near
      if (__builtin_add_overflow(key[axis], by, &near[axis])) continue;
      if (axis + 1 == N)
        body(near);
      else
        self(self, axis + 1, still_inside);
    }
  };
  step(step, 0, true);
}

}  // namespace gaussmap::detail
