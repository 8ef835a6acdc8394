// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

/// So far cells are looked for, at most [cells]. It takes the cube of it.
constexpr double kMostCells = 1000.0;

/// How many cells a distance [m] is, at least one. The distance is at most kMostCells cells.
inline std::int32_t cellsFor(double distance, double resolution) {
  return static_cast<std::int32_t>(std::fmax(1.0, std::round(distance / resolution)));
}

/// Calls body(cell) for the finest cells whose key differs from that of `cell` by `from` to `to` cells on the axis on
/// which it differs most; 1 <= from <= to.
template <typename Body>
void forNearCells(const GaussianMap<3>& map, std::size_t cell, std::int32_t from, std::int32_t to, const Body& body) {
  const CellKey<3> key = map.scale(0).keys[cell];
  const auto shifted = [](std::int32_t k, std::int32_t by, std::int32_t& out) {
    return !__builtin_add_overflow(k, by, &out);
  };
  CellKey<3> near;
  for (std::int32_t x = -to; x <= to; ++x) {
    if (!shifted(key[0], x, near[0])) continue;
    for (std::int32_t y = -to; y <= to; ++y) {
      if (!shifted(key[1], y, near[1])) continue;
      const bool inside = std::abs(x) < from && std::abs(y) < from;
      for (std::int32_t z = -to; z <= to; ++z) {
        if (inside && z == 1 - from) z = from;
        if (!shifted(key[2], z, near[2])) continue;
        if (const auto found = map.find(near, 0)) body(*found);
      }
    }
  }
}

}  // namespace gaussmap
