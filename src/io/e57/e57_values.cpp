// SPDX-License-Identifier: BSD-3-Clause
#include "io/e57/e57_values.h"

#include <cmath>
#include <set>
#include <string_view>
#include <utility>

namespace gaussmap::detail {
namespace {

using E57Names = std::array<std::string_view, 3>;
constexpr E57Names kCartesian = {"cartesianX", "cartesianY", "cartesianZ"};
constexpr E57Names kSpherical = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
constexpr E57Names kColours = {"colorRed", "colorGreen", "colorBlue"};
constexpr std::array<std::string_view, 5> kInvalid = {"cartesianInvalidState", "sphericalInvalidState",
                                                      "isColorInvalid", "isIntensityInvalid", "isTimeStampInvalid"};

std::optional<std::size_t> numberField(const E57Scan& scan, std::string_view name) {
  for (std::size_t i = 0; i < scan.fields.size(); ++i)
    if (scan.fields[i].name == name && scan.fields[i].encoding != E57Encoding::String) return i;
  return std::nullopt;
}

std::optional<std::array<std::size_t, 3>> numberFields(const E57Scan& scan, const E57Names& names) {
  std::array<std::size_t, 3> fields{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<std::size_t> field = numberField(scan, names[i]);
    if (!field) return std::nullopt;
    fields[i] = *field;
  }
  return fields;
}

/// Returns the limits of a colour, or std::nullopt if they are unknown. Integers of 8 bits are not scaled.
std::optional<E57Limits> limitsOf(const E57Field& field, const std::optional<E57Limits>& written) {
  constexpr E57Limits kByte = {0.0, 255.0};
  constexpr std::int64_t kLargest16 = 65535;
  const bool is_integer = field.encoding == E57Encoding::Integer;
  if (is_integer && field.minimum >= 0 && field.maximum <= 255) return kByte;
  if (written && is_integer && written->minimum >= 0.0 && written->maximum <= 255.0) return kByte;
  if (written && written->maximum > written->minimum && std::isfinite(written->maximum - written->minimum))
    return written;
  if (!written && is_integer && field.minimum >= 0 && field.maximum <= kLargest16)
    return E57Limits{static_cast<double>(field.minimum), static_cast<double>(field.maximum)};
  return std::nullopt;
}

/// Returns red, green and blue as one value, or std::nullopt if one of them or its limits are missing.
std::optional<E57Value> colourOf(const E57Scan& scan) {
  const auto fields = numberFields(scan, kColours);
  if (!fields) return std::nullopt;
  E57Value colour;
  colour.name = "rgb";
  colour.fields.assign(fields->begin(), fields->end());
  colour.invalid = numberField(scan, "isColorInvalid");
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<E57Limits> limits = limitsOf(scan.fields[(*fields)[i]], scan.colour_limits[i]);
    if (!limits) return std::nullopt;
    colour.limits[i] = *limits;
  }
  return colour;
}

std::string_view withoutPrefix(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

E57Value valueOfField(const E57Scan& scan, std::size_t index) {
  E57Value value;
  value.fields = {index};
  const std::string& name = scan.fields[index].name;
  value.name = name;
  if (name == "rowIndex") value.name = "row";
  if (name == "columnIndex") value.name = "column";
  if (name == "timeStamp") value.name = "time";
  if (name == "timeStamp") value.invalid = numberField(scan, "isTimeStampInvalid");
  if (name == "intensity") value.invalid = numberField(scan, "isIntensityInvalid");
  return value;
}

template <typename Names, typename Name>
bool contains(const Names& names, const Name& name) {
  for (const auto& one : names)
    if (one == name) return true;
  return false;
}

}  // namespace

std::optional<E57Coordinates> coordinatesOf(const E57Scan& scan) {
  for (const bool is_spherical : {false, true}) {
    const auto fields = numberFields(scan, is_spherical ? kSpherical : kCartesian);
    if (!fields) continue;
    return E57Coordinates{*fields, is_spherical,
                          numberField(scan, is_spherical ? "sphericalInvalidState" : "cartesianInvalidState")};
  }
  return std::nullopt;
}

std::vector<E57Value> valuesOf(const E57Scan& scan, const E57Coordinates& coordinates) {
  std::vector<E57Value> values;
  std::set<std::string> names;
  const std::optional<E57Value> colour = colourOf(scan);
  // Fields of the standard come first, so that an extension cannot take their names.
  for (const bool is_extension : {false, true})
    for (std::size_t i = 0; i < scan.fields.size(); ++i) {
      const E57Field& field = scan.fields[i];
      const std::string_view local = withoutPrefix(field.name);
      if ((local.size() != field.name.size()) != is_extension || field.encoding == E57Encoding::String) continue;
      if (contains(coordinates.fields, i) || contains(kInvalid, field.name)) continue;
      if (colour && contains(kColours, field.name)) {
        if (field.name == kColours[0] && names.insert(colour->name).second) values.push_back(*colour);
        continue;
      }
      E57Value value = valueOfField(scan, i);
      if (is_extension && !local.empty() && names.count(std::string(local)) == 0) value.name = local;
      if (names.insert(value.name).second) values.push_back(std::move(value));
    }
  return values;
}

}  // namespace gaussmap::detail
