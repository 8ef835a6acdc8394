// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace gaussmap::detail {

/// True if listScans() takes a file of this name in a directory for a scan.
bool isScanName(const std::filesystem::path& name);

/// True if a comes before b as people count: numbers in names by their value, scan2 before scan10.
bool naturalLess(const std::string& a, const std::string& b);

}  // namespace gaussmap::detail
