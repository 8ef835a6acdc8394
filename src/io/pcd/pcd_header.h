// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include "gaussmap/io/pcd/pcd_reader.h"

namespace gaussmap::detail {

/// Returns true if a file starts like a PCD file: with the comment "# .PCD", or with a keyword of the header.
bool isPcd(std::string_view start);

/// Reads the header at the start of a file. The result is consistent: the fields x, y and z exist, sizes and offsets do
/// not overflow, and POINTS = WIDTH * HEIGHT. The data are not checked. Throws FileError if the header is invalid.
PcdHeader parsePcdHeader(const std::filesystem::path& path, std::string_view bytes);

}  // namespace gaussmap::detail
