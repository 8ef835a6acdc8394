// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "io/e57/e57_description.h"
#include "io/e57/e57_pages.h"

namespace gaussmap::detail {

/// The packets of the points of a scan, as logical offsets.
struct E57Section {
  std::uint64_t begin = 0, end = 0;
};

/// Finds the packets of each scan.
///
/// Throws FileError if a section of points is not inside the file, or if it is too small for the points that the XML
/// section claims. Afterwards the points of all scans together are at most 8 per byte of the file, or at most 1 per
/// byte if they take no space because all fields are constant.
std::vector<E57Section> findE57Sections(const E57Pages& pages, const E57Description& description);

/// The bytes of one field of all points, joined from the packets.
struct E57Stream {
  std::unique_ptr<char[]> bytes;  ///< followed by 16 bytes of zeros
};

/// Joins the bytes of some fields. `fields` are different indices of fields, no strings. Needs as much memory as these
/// fields have in the file.
///
/// Throws FileError if the packets are damaged, or if they hold fewer or more points than the XML section claims.
std::vector<E57Stream> loadE57Streams(const E57Pages& pages, const E57Scan& scan, std::size_t scan_number,
                                      const E57Section& section, const std::vector<std::size_t>& fields);

}  // namespace gaussmap::detail
