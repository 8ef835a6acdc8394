// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include "gaussmap/io/pcd/pcd_reader.h"

namespace gaussmap::detail {

/// Reads the header at the start of a file. What it returns is consistent in itself: x y z are there, sizes and
/// offsets do not overflow, POINTS = WIDTH * HEIGHT. Nothing is said about the data. Throws FileError.
PcdHeader parsePcdHeader(const std::filesystem::path& path, std::string_view bytes);

}  // namespace gaussmap::detail
