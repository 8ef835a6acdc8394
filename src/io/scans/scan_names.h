// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns true if listScans() treats a file with this name in a directory as a scan.
GAUSSMAP_API bool isScanName(const std::filesystem::path& name);

/// Returns true if a comes before b in natural order: numbers in names are compared by value, for example
/// scan2 before scan10.
bool naturalLess(const std::string& a, const std::string& b);

}  // namespace gaussmap::detail
