// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "io/formats/scan_file.h"
#include "io/las/las_header.h"
#include "io/laz/laz_layout.h"

namespace gaussmap::detail {

class MappedFile;

/// Returns true if a file starts like a LAZ or COPC file. 105 bytes are enough to tell it from a LAS file.
bool isLaz(std::string_view start);

/// Opens a LAZ or COPC file: one scan in the map frame. Reads the header and the table of chunks.
///
/// The first read of a reader decodes all points; it keeps 12 bytes per point. Each call of values() decodes the file
/// again. Throws FileError if the file is damaged, contradicts itself, or has a format that is not supported.
std::unique_ptr<ScanFile> openLaz(const std::filesystem::path& path);

/// A LAZ file that is open.
struct LazSource {
  std::filesystem::path path;
  std::shared_ptr<const MappedFile> file;
  LasHeader header;
  LazLayout layout;
  LazChunks chunks;
};

/// Opens a file and checks it as openLaz() does.
std::shared_ptr<const LazSource> openLazSource(const std::filesystem::path& path);

/// Decodes all points and calls `take` with groups of records, as a LAS file would have them. `layers`: parts that are
/// needed, see LazLayers. Throws FileError with the number of the chunk if the data are damaged.
void decodeLaz(const LazSource& source, unsigned layers,
               const std::function<void(const char* records, std::size_t count)>& take);

}  // namespace gaussmap::detail
