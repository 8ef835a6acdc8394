// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Opens a PCD file. Throws FileError like PcdReader, and if the file holds the Gaussians of a map.
std::unique_ptr<ScanFile> openPcd(const std::filesystem::path& path);

}  // namespace gaussmap::detail
