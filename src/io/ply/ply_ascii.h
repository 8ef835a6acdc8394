// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "io/ply/ply_header.h"

namespace gaussmap::detail {

/// Returns properties of all vertices of an ASCII file. `bytes` is the whole file, and `vertex` the number of the
/// element. The numbers of the properties must be ascending, and none may be a list. Floats are rounded as in a binary
/// file. Throws FileError with the line if the data are damaged.
std::vector<std::vector<double>> parsePlyAscii(const std::filesystem::path& path, const PlyHeader& header,
                                               std::string_view bytes, std::size_t vertex,
                                               const std::vector<std::size_t>& properties);

}  // namespace gaussmap::detail
