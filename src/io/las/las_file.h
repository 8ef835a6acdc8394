// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Returns true if a file starts like an uncompressed LAS file. 105 bytes are enough to tell it from a LAZ file.
bool isLas(std::string_view start);

/// Opens a LAS file of version 1.0 to 1.4 with any point format. The file is one scan in the map frame, and
/// lasFields() lists the values.
///
/// Throws FileError if the header is damaged, if the file is cut off, if it is a LAZ file, or if the coordinates are
/// degrees. There is a warning if the header and the points contradict each other in a way that does not harm the
/// points, and if the coordinates are not metres.
std::unique_ptr<ScanFile> openLas(const std::filesystem::path& path);

}  // namespace gaussmap::detail
