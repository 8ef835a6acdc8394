// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/las/las_header.h"

namespace gaussmap::detail {

/// Returns warnings about the bounding box of the header: it is not a box, or a point lies far outside of it, so that
/// the scale or the offset can be wrong. About 64 of the points are checked. `records` are `count` uncompressed points.
std::vector<std::string> lasBoxWarnings(const LasHeader& header, const char* records, std::size_t count);

}  // namespace gaussmap::detail
