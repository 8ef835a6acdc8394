// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/scan_records.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace gaussmap::detail {
namespace {

bool fitsFloat(double value) {
  return !std::isfinite(value) || static_cast<double>(static_cast<float>(value)) == value;
}

/// Returns true if a value is whole by its meaning, so that scans of one recording get the same type.
bool isWhole(const std::string& name) {
  static const std::set<std::string> kWholeNames = {"rgb",
                                                    "ring",
                                                    "label",
                                                    "row",
                                                    "column",
                                                    "return_number",
                                                    "classification",
                                                    "number_of_returns",
                                                    "user_data",
                                                    "point_source_id",
                                                    "withheld",
                                                    "overlap",
                                                    "scanner_channel"};
  return kWholeNames.count(name) > 0;
}

bool fitsUnsigned(double value) {
  return value >= 0.0 && value <= static_cast<double>(std::numeric_limits<std::uint32_t>::max()) &&
         std::floor(value) == value;
}

template <typename T>
void putAll(const std::vector<double>& values, std::size_t offset, std::size_t record, std::vector<char>& bytes) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T value = static_cast<T>(values[i]);
    std::memcpy(bytes.data() + i * record + offset, &value, sizeof(value));
  }
}

/// Adds a field at the end of the record.
void addField(const std::string& name, char type, std::size_t size, PcdRecords& records) {
  PcdField& field = records.fields.emplace_back();
  field.name = name;
  field.type = type;
  field.size = size;
  field.count = 1;
  field.offset = records.record_size;
  field.column = records.fields.size() - 1;
  records.record_size += size;
}

std::array<std::vector<double>, 3> coordinatesOf(const ScanReader& reader) {
  std::array<std::vector<double>, 3> coordinates;
  for (std::vector<double>& axis : coordinates) axis.reserve(reader.size());
  PointBlock<3> block;
  for (std::size_t first = 0; reader.read(first, block), block.size > 0; first += block.size)
    for (std::size_t axis = 0; axis < 3; ++axis)
      coordinates[axis].insert(coordinates[axis].end(), block.coordinate[axis], block.coordinate[axis] + block.size);
  reader.requireWhole();
  return coordinates;
}

}  // namespace

PcdRecords recordsOf(const ScanReader& reader, const Pose& viewpoint) {
  PcdRecords records;
  records.viewpoint = viewpoint;
  records.width = static_cast<std::size_t>(reader.columns());
  std::vector<std::vector<double>> columns;
  for (std::vector<double>& axis : coordinatesOf(reader)) columns.push_back(std::move(axis));
  const bool floats = std::all_of(columns.begin(), columns.end(), [](const std::vector<double>& axis) {
    return std::all_of(axis.begin(), axis.end(), fitsFloat);
  });
  for (const char* const name : {"x", "y", "z"}) addField(name, 'F', floats ? 4 : 8, records);
  for (const std::string& name : reader.valueNames()) {
    std::vector<double> values = reader.values(name);
    if (isWhole(name) && std::all_of(values.begin(), values.end(), fitsUnsigned))
      addField(name, 'U', 4, records);
    else
      addField(name, 'F', name != "time" && std::all_of(values.begin(), values.end(), fitsFloat) ? 4 : 8, records);
    columns.push_back(std::move(values));
  }
  records.bytes.resize(reader.size() * records.record_size);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const PcdField& field = records.fields[i];
    if (field.type == 'U')
      putAll<std::uint32_t>(columns[i], field.offset, records.record_size, records.bytes);
    else if (field.size == 4)
      putAll<float>(columns[i], field.offset, records.record_size, records.bytes);
    else
      putAll<double>(columns[i], field.offset, records.record_size, records.bytes);
  }
  return records;
}

}  // namespace gaussmap::detail
