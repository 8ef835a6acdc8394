// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"

namespace gaussmap {

/// The scans that a command line means: files as they are, directories replaced by the *.pcd in them (in any case, not
/// recursively, no hidden files) in natural order. The order of the inputs stays. Throws FileError if an input does
/// not exist or a directory has no such file.
std::vector<std::filesystem::path> listScans(const std::vector<std::filesystem::path>& inputs);

/// True if listScans() takes a file of this name in a directory for a scan.
bool isScanName(const std::filesystem::path& name);

/// True if a comes before b as people count: numbers in names by their value, scan2 before scan10.
bool naturalLess(const std::string& a, const std::string& b);

}  // namespace gaussmap
