// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

#include "gaussmap/io/pcd/pcd_reader.h"

// The body of a PCD file, which follows the header. `data` always holds the bytes from header.data_offset to the end.
namespace gaussmap::detail {

/// Checks that the data can hold the points that the header claims. The points are not read. After this check, the
/// product points * record_size does not overflow and is within a constant factor of the file's size. Throws FileError.
void checkPcdBody(const std::filesystem::path& path, const PcdHeader& header, std::string_view data);

/// How the words of a column are read.
enum class AsciiKind {
  Double,    ///< as doubles
  Single,    ///< as doubles that are rounded to float, because the header says F 4
  Signed,    ///< exactly, as 64-bit integers
  Unsigned,  ///< exactly, as unsigned 64-bit integers
};

/// A column to be read from an ASCII body.
struct AsciiColumn {
  std::size_t column;  ///< in [0, header.columns)
  AsciiKind kind = AsciiKind::Double;
  std::vector<double> values = {};
  std::vector<std::uint64_t> integers = {};  ///< instead of `values` if the kind is Signed or Unsigned
};

/// Converts a number to T. If an integer type cannot hold the number, the result is the nearest limit of the type (NaN:
/// the minimum), because a cast would be undefined behaviour.
template <typename T>
T nearestOf(double number) {
  if constexpr (std::is_integral_v<T>) {
    using Limits = std::numeric_limits<T>;
    if (!(number > static_cast<double>(Limits::min()))) return Limits::min();
    if (number >= static_cast<double>(Limits::max())) return Limits::max();
  }
  return static_cast<T>(number);
}

/// Fills the columns in one pass over the text. They must be in ascending order. Throws FileError with the line.
void parsePcdAscii(const std::filesystem::path& path, const PcdHeader& header, std::string_view data,
                   std::vector<AsciiColumn>& columns);

/// Position of the elements of a field in a binary body; for DATA binary_compressed, in the expanded body.
struct PcdStride {
  std::size_t offset;  ///< offset of the first element of the first point [bytes]
  std::size_t step;    ///< distance from point to point [bytes]
};

/// The expanded body of DATA binary_compressed. It stores all points of the first field, then all points of the next.
class PcdExpanded {
 public:
  /// Expands the data. Throws FileError if they do not expand to exactly the claimed size.
  PcdExpanded(const std::filesystem::path& path, const PcdHeader& header, std::string_view data);
  const char* bytes() const { return bytes_.get(); }
  PcdStride strideOf(const PcdField& field) const;

 private:
  const PcdHeader& header_;
  std::unique_ptr<char[]> bytes_;
  bool has_padding_ = true;  // true: the data hold the fields named _, which PCL leaves out of compressed data
};

}  // namespace gaussmap::detail
