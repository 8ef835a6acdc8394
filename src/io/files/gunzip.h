// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace gaussmap::detail {

/// Returns true if a file starts like a gzip file.
bool isGzip(std::string_view bytes);

/// Returns the maximum size to which a gzip file of this size may expand: 16 MiB and 100 times its own size. The limit
/// keeps a small file from filling the memory.
std::size_t maxGunzipped(std::size_t bytes);

/// Expands the bytes of a gzip file, which can consist of several parts. Throws FileError if they are damaged, cut off,
/// or expand to more than maxGunzipped().
std::string gunzip(const std::filesystem::path& path, std::string_view bytes);

/// Expands only the first `length` bytes, or less if the file is shorter. Throws FileError if they are damaged.
std::string gunzipStart(const std::filesystem::path& path, std::string_view bytes, std::size_t length);

}  // namespace gaussmap::detail
