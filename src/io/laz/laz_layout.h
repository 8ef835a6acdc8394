// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/las/las_header.h"
#include "io/laz/chunk_decoder.h"

namespace gaussmap::detail {

/// How the points of a LAZ file are compressed: the record "laszip encoded", number 22204.
struct LazLayout {
  std::vector<LazItem> items;
  bool is_layered = false;         ///< formats 6 to 10
  bool has_chunks = true;          ///< false: the first LASzip, all points are one chunk without a table
  std::uint64_t chunk_points = 0;  ///< points per chunk; 0: each chunk has its own number
};

/// Reads the record and checks it against the header. Throws FileError if the file is not compressed, if the record is
/// missing or wrong, or if the point format or the version of an item is not supported.
LazLayout parseLazLayout(const std::filesystem::path& path, const LasHeader& header);

/// A group of points that is compressed on its own.
struct LazChunk {
  std::size_t offset = 0;         ///< position in the file [bytes]
  std::size_t size = 0;           ///< [bytes]
  std::uint64_t first_point = 0;  ///< number of its first point in the file
  std::uint64_t points = 0;       ///< number of points, at least 1
};

/// The chunks of a file.
struct LazChunks {
  std::size_t first_byte = 0;   ///< position of the first chunk
  std::vector<LazChunk> table;  ///< all chunks; empty if the file has no table of chunks
  std::string warning;          ///< about a missing table; else empty
};

/// Reads the table of chunks. The chunks lie in the file and hold all points of the header. Throws FileError if the
/// table is damaged or contradicts the header, or if the file is cut off.
LazChunks findLazChunks(const std::filesystem::path& path, std::string_view bytes, const LasHeader& header,
                        const LazLayout& layout);

}  // namespace gaussmap::detail
