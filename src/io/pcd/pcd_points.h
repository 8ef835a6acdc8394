// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Reads points, as the inverse of writePcd(). It copies each point to the memory that `fields` point to, then calls
/// body(i). This memory belongs to the caller and must be writable. Throws FileError unless the file has all these
/// fields with the same types, sizes and counts; the message uses `what` as the name of the expected content.
GAUSSMAP_API void readPoints(const PcdReader& reader, const std::vector<PcdOutput>& fields, const std::string& what,
                             const std::function<void(std::size_t)>& body);

}  // namespace gaussmap::detail
