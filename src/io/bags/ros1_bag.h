// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "io/formats/message_file.h"

namespace gaussmap::detail {

/// Returns true if a file starts like a bag of ROS 1, of any version.
bool isRos1Bag(std::string_view start);

/// Opens a bag of ROS 1, version 2.0. `shown` is its path in messages. Throws FileError.
std::unique_ptr<MessageFile> openRos1Bag(const std::filesystem::path& path, const std::filesystem::path& shown);

}  // namespace gaussmap::detail
