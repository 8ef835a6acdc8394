// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"

namespace gaussmap::detail {

/// The way back from writePcd(): reads point after point to where `fields` point, memory of the caller's that may be
/// written, and calls body(i) after each. Throws FileError, saying that the file is no `what`, unless it has all these
/// fields with the same types, sizes and counts.
void readPoints(const PcdReader& reader, const std::vector<PcdOutput>& fields, const std::string& what,
                const std::function<void(std::size_t)>& body);

}  // namespace gaussmap::detail
