// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "io/formats/message_file.h"

namespace gaussmap::detail {

/// Returns true if a file starts like an SQLite database without an application id. Files of rosbag2 have none, map
/// files have one. Needs the first 100 bytes.
bool isSqliteWithoutApplicationId(std::string_view start);

/// Returns true if a database has the tables of rosbag2. Returns false if it cannot be read.
bool hasRosbag2Tables(const std::filesystem::path& path);

/// Opens a database of rosbag2 (.db3), of the versions 1 to 4 of its schema. `shown` is its path in messages. Throws
/// FileError.
std::unique_ptr<MessageFile> openRosbag2Database(const std::filesystem::path& path, const std::filesystem::path& shown);

}  // namespace gaussmap::detail
