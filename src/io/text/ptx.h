// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "io/files/mapped_file.h"
#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Returns true if a text starts like a PTX file of Leica: two lines with one number each, then a line with three.
/// `text` can end anywhere.
bool isPtx(std::string_view text);

/// Opens a PTX file. See openCloudText().
std::unique_ptr<ScanFile> openPtx(const std::filesystem::path& path, std::shared_ptr<const MappedFile> file);

}  // namespace gaussmap::detail
