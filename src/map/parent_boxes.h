// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/map/grid.h"

namespace gaussmap::detail {

/// Returns one box per cluster, for `count` clusters: the bounds of the boxes of its members. parent[i] is the cluster
/// of box i. A cluster without members has no box: its `low` is infinite.
template <int D>
std::vector<Box<D>> parentBoxes(const std::vector<Box<D>>& members, const std::vector<std::uint32_t>& parent,
                                std::size_t count);

}  // namespace gaussmap::detail
