// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/text_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iterator>
#include <utility>

#include "gaussmap/core/error.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Sets the unit of times without one: clocks that count from 1970 tell it by their size.
void guessTimeUnit(PointValue& value, const ColumnSample& sample, std::vector<std::string>& warnings) {
  constexpr double kDay = 86400.0;
  const Extent extent = extentOf(sample);
  const char* unit = "seconds";
  if (extent.low > 1e17) {
    value.divisor = 1e9;
    unit = "nanoseconds";
  } else if (extent.low > 1e14) {
    value.divisor = 1e6;
    unit = "microseconds";
  } else if (extent.low > 1e11) {
    value.divisor = 1e3;
    unit = "milliseconds";
  } else if (!isWhole(sample) || extent.high - extent.low <= kDay) {
    return;
  }
  warnings.push_back("the times from " + shortNumber(extent.low) + " to " + shortNumber(extent.high) +
                     " are taken as " + unit + "; give another unit with --fields, for example \"x y z time:us\"");
}

/// Sets the scale of three colour channels. Returns false if they are not colours.
bool guessColourScale(PointValue& value, const std::vector<ColumnSample>& samples, std::vector<std::string>& warnings) {
  bool is_whole = true;
  double low = 0.0, high = 0.0;
  for (const std::size_t column : value.columns) {
    is_whole = is_whole && isWhole(samples[column]);
    low = std::min(low, extentOf(samples[column]).low);
    high = std::max(high, extentOf(samples[column]).high);
  }
  if (low < 0.0 || high > 65535.0) return false;
  if (high <= 1.0 && !is_whole) {
    value.divisor = 1.0 / 255.0;
  } else if (high > 255.0) {
    value.divisor = 257.0;
    warnings.push_back("the colours go up to " + shortNumber(high) + " and are taken as 16-bit numbers");
  }
  return true;
}

std::string columnName(const TextHead& head, std::size_t column) {
  std::string name = "column " + std::to_string(column + 1);
  return column < head.names.size() ? name + " " + quote(head.names[column]) : name;
}

constexpr const char* kUseFields = "name the columns, for example with --fields \"x y z intensity\"";

/// Refuses columns that are not x y z although no header says so.
void requireNoOtherOrder(const std::filesystem::path& path, const std::vector<ColumnSample>& samples) {
  constexpr std::size_t kEnough = 8;
  const std::vector<double>& first = samples[0].values;
  if (samples.size() < 4 || first.size() < kEnough) return;
  constexpr double kClock = 1e8;  // seconds since 1970 are larger, and coordinates of maps are smaller
  const bool is_clock = std::is_sorted(first.begin(), first.end()) && extentOf(samples[0]).low > kClock &&
                        extentOf(samples[1]).high < kClock;
  if (is_clock)
    throw FileError(path, "column 1 holds times, for example " + shortNumber(first.front()) + ", so it is not x; " +
                              "use --fields \"time x y z\" with a name for each column");
  // The samples are runs of rows that follow each other. The first run has at least kEnough rows.
  const bool counts = std::adjacent_find(first.begin(), first.end(), std::greater_equal<>()) == first.end();
  const bool is_whole_only = isWhole(samples[0]) && !isWhole(samples[1]) && !isWhole(samples[2]);
  if (counts || is_whole_only)
    throw FileError(path, "column 1 " +
                              std::string(counts ? "grows from row to row like a number or a time"
                                                 : "holds whole numbers like an index or a class") +
                              ", so it may not be x; skip it with --fields \"- x y z\", or give the names "
                              "\"x y z\" if it is x");
}

/// Names the columns of a text without a header.
std::vector<PointField> guessNames(const std::filesystem::path& path, const TextHead& head,
                                   const std::vector<ColumnSample>& samples, std::vector<std::string>& warnings) {
  const std::size_t columns = samples.size();
  const auto fail = [&](const std::string& what) {
    throw FileError(path, "line " + std::to_string(head.row_line) + ": " + what);
  };
  if (columns < 3) fail(std::to_string(columns) + (columns == 1 ? " column" : " columns") + " instead of x, y and z");
  requireNoOtherOrder(path, samples);
  std::vector<PointField> fields(columns);
  const auto name = [&fields](std::size_t first, const std::vector<const char*>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) fields[first + i].name = names[i];
  };
  const std::vector<const char*> colours(std::begin(kColourChannels), std::end(kColourChannels));
  const std::vector<const char*> normals = {"normal_x", "normal_y", "normal_z"};
  name(0, {"x", "y", "z"});
  bool clear = columns == 3;
  if (columns == 4) {
    if (!head.counted && extentOf(samples[3]).low < 0.0 && !isWhole(samples[3]))
      fail("4 columns without names, and the last one is negative in places, so it is no intensity; " +
           std::string(kUseFields));
    name(3, {"intensity"});
    clear = true;
  } else if (columns == 6 && areColours(samples, 3)) {
    name(3, colours);
    clear = true;
  } else if (columns == 6 && areNormals(samples, 3)) {
    name(3, normals);
    clear = true;
  } else if (columns == 6 && areColourFractions(samples, 3)) {
    name(3, colours);
    clear = true;
    warnings.push_back("columns 4 to 6 have no names; they lie between 0 and 1 and are taken as red, green and blue");
  } else if (columns == 7 && areColours(samples, 4) && (head.counted || !areColours(samples, 3))) {
    name(3, {"intensity"});
    name(4, colours);
    clear = true;
  } else if (columns == 9 && areColours(samples, 3) && areNormals(samples, 6)) {
    name(3, colours);
    name(6, normals);
    clear = true;
  } else if (columns == 9 && areNormals(samples, 3) && areColours(samples, 6)) {
    name(3, normals);
    name(6, colours);
    clear = true;
  } else if (columns == 10 && areColours(samples, 4) && areNormals(samples, 7)) {
    name(3, {"intensity"});
    name(4, colours);
    name(7, normals);
    clear = true;
  }
  // A row of a trajectory has 8 columns (time, position, quaternion) or 12 (matrix).
  const char* const poses = columns == 8 || columns == 12 ? "; if the rows are poses, give the file with --poses" : "";
  if (!clear)
    fail(std::to_string(columns) + " columns without names; " + kUseFields + " (\"-\" skips a column)" + poses);
  return fields;
}

/// Leaves out columns that hold texts. Throws FileError if a coordinate is one of them.
void dropTexts(const std::filesystem::path& path, const TextHead& head, const std::vector<ColumnSample>& samples,
               std::vector<PointField>& fields, std::vector<std::string>& warnings) {
  std::string dropped;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    std::string& name = fields[i].name;
    if (samples[i].numeric || name.empty()) continue;
    if (name == "x" || name == "y" || name == "z")
      throw FileError(path, "line " + std::to_string(samples[i].text_line) + ": " + notANumber(samples[i].text) +
                                ", but " + columnName(head, i) + " must be " + name + "; correct the line, or " +
                                kUseFields);
    dropped += (dropped.empty() ? "" : ", ") + columnName(head, i);
    name.clear();
  }
  if (!dropped.empty()) warnings.push_back("these columns hold texts and are not used: " + dropped);
}

}  // namespace

PointLayout layOutFields(const std::vector<PointField>& fields, const std::vector<ColumnSample>& samples) {
  PointLayout layout;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    layout.coordinates[axis] = indexOf(fields, std::string(1, static_cast<char>('x' + axis)));
    layout.divisors[axis] = fields[layout.coordinates[axis]].divisor;
  }
  PointValue colour{"rgb", ValueKind::Channels};
  for (const char* const channel : kColourChannels)
    if (const std::size_t column = indexOf(fields, channel); column < fields.size()) colour.columns.push_back(column);
  bool has_colours = colour.columns.size() == std::size(kColourChannels) && indexOf(fields, "rgb") == fields.size();
  if (has_colours && !guessColourScale(colour, samples, layout.warnings)) {
    layout.warnings.push_back("red, green and blue are not used: they are not between 0 and 255");
    has_colours = false;
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const PointField& field = fields[i];
    const bool is_coordinate =
        std::find(std::begin(layout.coordinates), std::end(layout.coordinates), i) != std::end(layout.coordinates);
    if (field.name.empty() || is_coordinate) continue;
    const bool is_channel = std::find(colour.columns.begin(), colour.columns.end(), i) != colour.columns.end();
    if (is_channel && has_colours) {
      if (i == colour.columns.front()) layout.values.push_back(colour);
      continue;
    }
    PointValue value{field.name, field.name == "rgb" ? ValueKind::Packed : ValueKind::Plain, {i}, field.divisor};
    if (field.name == "time" && !field.has_unit) guessTimeUnit(value, samples[i], layout.warnings);
    layout.values.push_back(std::move(value));
  }
  return layout;
}

PointLayout layOutText(const std::filesystem::path& path, const TextHead& head,
                       const std::vector<ColumnSample>& samples, const std::vector<PointField>& given) {
  std::vector<std::string> warnings;
  std::vector<PointField> fields = given;
  const auto requireCount = [&](std::size_t names, const std::string& what) {
    if (names != head.columns)
      throw FileError(path, "line " + std::to_string(head.row_line) + ": " + std::to_string(head.columns) +
                                (head.columns == 1 ? " column" : " columns") + ", but " + what +
                                (given.empty() ? std::string("; ") + kUseFields : " (\"-\" skips a column)"));
  };
  if (!fields.empty()) {
    requireCount(fields.size(), "--fields names " + std::to_string(fields.size()));
  } else if (!head.names.empty()) {
    requireCount(head.names.size(),
                 "line " + std::to_string(head.names_line) + " names " + std::to_string(head.names.size()));
    NamedColumns named = nameColumns(head.names);
    if (!named.fault.empty())
      throw FileError(path, "line " + std::to_string(head.names_line) + ": " + named.fault + "; or " + kUseFields);
    fields = std::move(named.fields);
  } else {
    fields = guessNames(path, head, samples, warnings);
  }
  dropTexts(path, head, samples, fields, warnings);
  PointLayout layout = layOutFields(fields, samples);
  layout.warnings.insert(layout.warnings.begin(), warnings.begin(), warnings.end());
  return layout;
}

std::vector<double> makeValue(const std::filesystem::path& path, const PointValue& value,
                              std::vector<std::vector<double>> columns) {
  std::vector<double> made = std::move(columns[0]);
  const auto failAt = [&](std::size_t point, double found, const char* expected) {
    throw FileError(path,
                    "point " + std::to_string(point) + ": the colour " + shortNumber(found) + " is not " + expected);
  };
  if (value.kind == ValueKind::Plain) {
    if (value.divisor != 1.0)
      for (double& number : made) number /= value.divisor;
  } else if (value.kind == ValueKind::Packed) {
    for (std::size_t i = 0; i < made.size(); ++i) {
      if (std::isnan(made[i])) continue;
      if (!(made[i] >= 0.0 && made[i] <= 4294967295.0) || made[i] != std::floor(made[i]))
        failAt(i, made[i], "a whole number of 24 or 32 bits");
      made[i] = static_cast<double>(static_cast<std::uint32_t>(made[i]) & 0xFFFFFFu);
    }
  } else {
    for (std::size_t i = 0; i < made.size(); ++i) {
      double packed = 0.0;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const double number = channel == 0 ? made[i] : columns[channel][i];
        const double rounded = std::round(number / value.divisor);
        if (rounded < 0.0 || rounded > 255.0)
          failAt(i, number, ("between 0 and " + shortNumber(255.0 * value.divisor)).c_str());
        packed = packed * 256.0 + rounded;  // NaN stays NaN
      }
      made[i] = packed;
    }
  }
  return made;
}

}  // namespace gaussmap::detail
