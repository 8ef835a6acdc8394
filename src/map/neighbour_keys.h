// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace gaussmap::detail {

/// So far cells are looked for, at most [cells]. It takes the cube of it.
constexpr double kMaxCells = 1000.0;

/// How many cells a distance [m] is, at least one. The distance is at most kMaxCells cells.
inline std::int32_t cellsFor(double distance, double resolution) {
  return static_cast<std::int32_t>(std::fmax(1.0, std::round(distance / resolution)));
}

/// Calls body(key) for the 3^N keys that differ from `key` by at most one cell on every axis, `key` itself among them.
/// The first axis varies fastest. Keys beyond 32 bits are left out.
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

/// Calls body(key) for the keys that differ from `key` by `from` to `to` cells on the axis on which they differ most;
/// 1 <= from <= to. Keys beyond 32 bits are left out.
template <std::size_t N, typename Body>
void forNearKeys(const std::array<std::int32_t, N>& key, std::int32_t from, std::int32_t to, const Body& body) {
  std::array<std::int32_t, N> near = key;
  const auto step = [&](const auto& self, std::size_t axis, bool inside) -> void {
    for (std::int32_t by = -to; by <= to; ++by) {
      const bool still_inside = inside && std::abs(by) < from;
      if (axis + 1 == N && still_inside) by = from;  // over what is too near
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
