// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gaussmap::detail {

/// Returns the files of a list of inputs like gaussmap::listScans(). Adds a warning for each directory with files of
/// several kinds.
std::vector<std::filesystem::path> listScans(const std::vector<std::filesystem::path>& inputs,
                                             std::vector<std::string>& warnings);

}  // namespace gaussmap::detail
