// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fuzz_scan_file.h"
#include "io/e57/e57_file.h"

namespace gaussmap::fuzz {

/// Reads the points and values of a file. A scan that is refused does not end the reading.
inline void readE57(const std::filesystem::path& path) {
  refusesOrReads([&] { readScans(*detail::openE57(path)); });
}

}  // namespace gaussmap::fuzz
