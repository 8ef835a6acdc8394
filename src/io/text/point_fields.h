// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/binary_numbers.h"

// Names, units and types of the columns of text files and of the fields of raw records.
namespace gaussmap::detail {

/// What one column of a text file or one field of a raw record holds.
struct PointField {
  std::string name;       ///< name in the interface ScanReader, "x", "y" or "z"; empty: the field is skipped
  double divisor = 1.0;   ///< metres or seconds = number / divisor
  bool has_unit = false;  ///< the unit was given
  NumberType type = NumberType::Float32;  ///< in raw records only
};

/// The names of the three channels of a colour, from which the value "rgb" is made.
inline constexpr const char* kColourChannels[3] = {"red", "green", "blue"};

/// Returns the index of the field with this name, or fields.size() if there is none.
std::size_t indexOf(const std::vector<PointField>& fields, std::string_view name);

/// Parses a list of fields that the user gives: "x y z intensity - time:ns" for text, and with types
/// "x y z ring:u16 time:f64 -:u8" for raw records. "-" skips a column.
///
/// Throws std::invalid_argument if the list is not valid, names a field twice, or has no x, y and z.
std::vector<PointField> parseFields(std::string_view text, bool with_types);

/// What the names in the header of a text file mean.
struct NamedColumns {
  std::vector<PointField> fields;  ///< one per name
  std::string fault;               ///< why they cannot be used; empty: nothing is wrong
};

/// Finds the meaning of the names in a header, for example "X", "x [m]", "Points:0", "Reflectance", "timestamp_ns".
/// Names without a known meaning stay as they are.
NamedColumns nameColumns(const std::vector<std::string_view>& names);

/// Returns true if a header has columns x, y and z.
bool namesCoordinates(const std::vector<std::string_view>& names);

}  // namespace gaussmap::detail
