// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "io/formats/message_file.h"

namespace gaussmap::detail {

/// Returns true if a file starts like an MCAP file.
bool isMcap(std::string_view start);

/// Opens an MCAP file. `shown` is its path in messages. Throws FileError.
std::unique_ptr<MessageFile> openMcap(const std::filesystem::path& path, const std::filesystem::path& shown);

}  // namespace gaussmap::detail
