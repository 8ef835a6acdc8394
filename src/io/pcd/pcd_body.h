// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "gaussmap/io/pcd/pcd_reader.h"

// The part of a PCD file behind its header. `data` are always the bytes from header.data_offset to the file's end.
namespace gaussmap::detail {

/// Refuses data that cannot hold the points the header claims, without reading them. After this, points * record_size
/// does not overflow and is within a constant factor of the file's size. Throws FileError.
void checkPcdBody(const std::filesystem::path& path, const PcdHeader& header, std::string_view data);

/// A column of an ascii body to be read.
struct AsciiColumn {
  std::size_t column;   ///< in [0, header.columns)
  bool single = false;  ///< round to float, as the header's F 4 says
  std::vector<double> values = {};
};

/// Fills the columns, which must be in ascending order, in one pass over the text. Throws FileError with the line.
void parsePcdAscii(const std::filesystem::path& path, const PcdHeader& header, std::string_view data,
                   std::vector<AsciiColumn>& columns);

/// Where the elements of a field are in a body of DATA binary_compressed once it is expanded.
struct PcdStride {
  std::size_t offset;  ///< of the first point's first element [bytes]
  std::size_t step;    ///< from point to point [bytes]
};

/// The expanded body: field after field, each with all its points.
class PcdExpanded {
 public:
  /// Throws FileError if the data do not expand to exactly the claimed size.
  PcdExpanded(const std::filesystem::path& path, const PcdHeader& header, std::string_view data);
  const char* bytes() const { return bytes_.get(); }
  PcdStride strideOf(const PcdField& field) const;

 private:
  const PcdHeader& header_;
  std::unique_ptr<char[]> bytes_;
  bool has_padding_ = true;  // PCL leaves fields named _ out of compressed data, other writers may not
};

}  // namespace gaussmap::detail
