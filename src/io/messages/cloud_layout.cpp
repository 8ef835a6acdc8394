// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/cloud_layout.h"

#include <algorithm>
#include <limits>
#include <set>

namespace gaussmap::detail {
namespace {

// Indexed by the type.
constexpr std::array<const char*, 8> kTypeNames = {"int8",  "uint8",  "int16",   "uint16",
                                                   "int32", "uint32", "float32", "float64"};
constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
// The names that drivers give to the time of a point. The first one that exists becomes "time".
constexpr std::array<std::string_view, 6> kTimes = {"time",       "t",           "timestamp",
                                                    "time_stamp", "offset_time", "time_offset"};
constexpr std::size_t kMostValues = 256;  // more are not listed, so that the list stays small
constexpr std::size_t kLongestName = 256;

std::string fieldName(const CloudField& field) {
  return "field '" + shown(field.name) + "'";
}

NumberType typeOf(const CloudField& field) {
  return static_cast<NumberType>(field.datatype - 1);
}

void checkField(const CloudField& field, std::size_t point_step, const MessageOrigin& origin) {
  if (field.datatype == 0 || field.datatype > kTypeNames.size())
    origin.fail(fieldName(field) + " has the datatype " + std::to_string(field.datatype) + ", expected 1 to 8");
  const std::size_t end = std::size_t{field.offset} + sizeOf(typeOf(field)) * std::max<std::size_t>(field.count, 1);
  if (end > point_step)
    origin.fail(fieldName(field) + " ends at byte " + std::to_string(end) + " of a point, but point_step is " +
                std::to_string(point_step));
}

CloudColumn axisOf(const CloudMessage& cloud, const char* name, const MessageOrigin& origin) {
  const CloudField* found = nullptr;
  std::string names;
  for (const CloudField& field : cloud.fields) {
    if (names.size() < 200) names += (names.empty() ? "" : " ") + std::string(field.name.substr(0, 40));
    if (field.name != name) continue;
    if (found) origin.fail(fieldName(field) + " occurs twice");
    found = &field;
  }
  if (!found)
    origin.fail("the cloud has no field '" + std::string(name) + "', its fields are " + shown(names) +
                ": a map needs x, y and z [m]");
  if (isWhole(typeOf(*found)))
    origin.fail(fieldName(*found) + " is " + kTypeNames[found->datatype - 1u] +
                ": integer coordinates have no known unit, expected float32 or float64");
  if (found->count > 1)
    origin.fail(fieldName(*found) + " has " + std::to_string(found->count) + " elements, expected 1");
  return {name, found->offset, typeOf(*found)};
}

/// Sets width, row_step and columns.
void layOutRows(const CloudMessage& cloud, CloudLayout& layout, const MessageOrigin& origin) {
  const std::size_t width = cloud.width, height = cloud.height, step = cloud.point_step, size = cloud.data_size;
  const bool fits = step > 0 && layout.points <= size / step;
  const std::size_t row = fits ? width * step : 0, row_step = cloud.row_step;
  if (fits && layout.points * step == size) {
    layout.row_step = row;  // no padding, so row_step does not matter. Some drivers leave it 0.
  } else if (fits && row_step >= row && (row_step * height == size || row_step * (height - 1) + row == size)) {
    layout.row_step = row_step;
  } else {
    origin.fail("the data have " + std::to_string(size) + " bytes, which contradicts width " + std::to_string(width) +
                ", height " + std::to_string(height) + ", point_step " + std::to_string(step) + " and row_step " +
                std::to_string(row_step));
  }
  layout.width = width;
  layout.point_step = step;
  if (height > 1 && width <= std::size_t{std::numeric_limits<int>::max()}) layout.columns = static_cast<int>(width);
}

/// Returns the name of the field that becomes the value "time", or an empty text.
std::string_view timeField(const CloudMessage& cloud) {
  for (const std::string_view name : kTimes)
    for (const CloudField& field : cloud.fields)
      if (field.name == name && field.count <= 1) return name;
  return "";
}

void listValues(const CloudMessage& cloud, CloudLayout& layout) {
  const std::string_view time = timeField(cloud);
  std::set<std::string_view> fields = {"x", "y", "z", ""};
  std::set<std::string> names;
  for (const CloudField& field : cloud.fields) {
    if (!fields.insert(field.name).second || field.name[0] == '_' || field.name.size() > kLongestName) continue;
    const std::size_t count = std::max<std::size_t>(field.count, 1);
    for (std::size_t element = 0; element < count && layout.values.size() < kMostValues; ++element) {
      std::string name = field.name == time ? "time" : std::string(field.name);
      if (count > 1) name += "[" + std::to_string(element) + "]";
      if (names.insert(name).second)
        layout.values.push_back({name, field.offset + element * sizeOf(typeOf(field)), typeOf(field)});
    }
  }
}

}  // namespace

CloudLayout layoutOf(const CloudMessage& cloud, const MessageOrigin& origin) {
  CloudLayout layout;
  layout.swapped = isSwapped(cloud.big_endian);
  layout.points = std::size_t{cloud.width} * cloud.height;
  if (layout.points == 0) {
    if (cloud.data_size > 0)
      origin.fail("the data have " + std::to_string(cloud.data_size) + " bytes, but width " +
                  std::to_string(cloud.width) + " and height " + std::to_string(cloud.height) + " mean no points");
    return layout;
  }
  layOutRows(cloud, layout, origin);
  for (const CloudField& field : cloud.fields) checkField(field, layout.point_step, origin);
  for (std::size_t axis = 0; axis < 3; ++axis) layout.axes[axis] = axisOf(cloud, kAxes[axis], origin);
  listValues(cloud, layout);
  return layout;
}

}  // namespace gaussmap::detail
