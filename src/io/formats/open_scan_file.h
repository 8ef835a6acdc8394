// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "gaussmap/io/scans/file_scans.h"
#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Opens a file with scans. The kind follows from the content. Throws FileError.
std::shared_ptr<const ScanFile> openScanFile(const std::filesystem::path& path, const FileOptions& options);

}  // namespace gaussmap::detail
