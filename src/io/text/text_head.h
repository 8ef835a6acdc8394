// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "io/text/point_fields.h"
#include "io/text/text_rows.h"

namespace gaussmap::detail {

/// What stands before the first row of a text, and the shape of the first row.
struct TextHead {
  std::vector<std::string_view> names;  ///< of the columns, if a header gives them
  std::size_t names_line = 0;           ///< line of the header
  bool counted = false;                 ///< the number of points stands before the rows of each scan, as in PTS
  TextPlace body;                       ///< the first number of points, or the first row
  bool has_row = false;
  std::size_t row_line = 0;  ///< line of the first row
  char separator = ' ';
  std::size_t columns = 0;
};

/// Returns the names in a header line, without a leading # or //. Units like "[m]" stay with their names.
std::vector<std::string_view> namesOf(std::string_view line);

/// Reads the start of a text up to the first row. `fields` are the names that the user gives; empty: none.
/// Throws FileError if the text does not start like a table of points.
TextHead readTextHead(const std::filesystem::path& path, std::string_view text, const std::vector<PointField>& fields);

}  // namespace gaussmap::detail
