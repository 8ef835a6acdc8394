// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

/// An axis-aligned box [m, map frame].
template <int D>
struct Box {
  Vector<D> low;
  Vector<D> high;
};

/// The box of the occupied cells, each at the finest scale that the map has there; nothing for an empty map.
template <int D>
std::optional<Box<D>> extentOf(const GaussianMap<D>& map);

}  // namespace gaussmap
