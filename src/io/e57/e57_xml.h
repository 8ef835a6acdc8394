// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "io/e57/e57_description.h"

namespace gaussmap::detail {

/// Returns "scan 3: ", the start of messages about a scan. The numbers count from 0, as in the E57 standard.
std::string e57Place(std::size_t scan);

/// Reads the XML section of an E57 file. Entities of a document type are not expanded. Throws FileError if it is
/// not XML, or if the description of a scan is incomplete or unknown.
E57Description parseE57Xml(const std::filesystem::path& path, std::string xml);

}  // namespace gaussmap::detail
