// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Returns true if a file starts like a PLY file. Four bytes are enough.
bool isPly(std::string_view start);

/// Opens a PLY file (ascii, binary_little_endian or binary_big_endian) and takes its vertices as the points of one scan
/// in the sensor frame. Faces and other elements are ignored. meaningOf() says which values the points have.
///
/// Throws FileError if the header is damaged, if the vertices have no x, y and z, or if the file is too short.
std::unique_ptr<ScanFile> openPlyCloud(const std::filesystem::path& path);

}  // namespace gaussmap::detail
