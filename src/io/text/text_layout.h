// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/text/column_samples.h"
#include "io/text/point_fields.h"
#include "io/text/text_head.h"

namespace gaussmap::detail {

/// How a value is made from columns.
enum class ValueKind {
  Plain,    ///< the number of the column, divided by the divisor
  Packed,   ///< a colour in one column, as a whole number
  Channels  ///< a colour from three columns, red green blue
};

/// A value of the points other than the coordinates.
struct PointValue {
  std::string name;
  ValueKind kind = ValueKind::Plain;
  std::vector<std::size_t> columns = {};
  double divisor = 1.0;  ///< of Plain and Channels
};

/// What the columns of a file hold.
struct PointLayout {
  std::size_t coordinates[3] = {0, 1, 2};  ///< columns of x, y and z
  double divisors[3] = {1.0, 1.0, 1.0};    ///< coordinate [m] = number / divisor
  std::vector<PointValue> values;
  std::vector<std::string> warnings;
};

/// Finds the layout from the names that the user gives (`fields`, can be empty), else from the header, else from the
/// samples. Throws FileError if it is not clear; the message names the option.
PointLayout layOutText(const std::filesystem::path& path, const TextHead& head,
                       const std::vector<ColumnSample>& samples, const std::vector<PointField>& fields);

/// Makes the layout of named columns. The samples decide the scale of colours and the unit of times.
PointLayout layOutFields(const std::vector<PointField>& fields, const std::vector<ColumnSample>& samples);

/// Returns the value made from its columns, one number per point. Throws FileError if a colour is out of range.
std::vector<double> makeValue(const std::filesystem::path& path, const PointValue& value,
                              std::vector<std::vector<double>> columns);

}  // namespace gaussmap::detail
