// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply/ply_names.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// Returns the name of a value for the name of its property.
std::string valueNameOf(std::string_view property) {
  constexpr std::string_view kScalar = "scalar_";
  if (property.size() > kScalar.size() && property.substr(0, kScalar.size()) == kScalar)
    property.remove_prefix(kScalar.size());
  std::string lower = lowerCase(property);
  for (const char* const known : {"intensity", "ring", "label", "time", "classification"})
    if (lower == known) return lower;
  if (lower == "gpstime" || lower == "gps_time") return "time";
  return std::string(property);
}

/// The numbers of the properties that are not lists, by name.
class PropertyIndex {
 public:
  explicit PropertyIndex(const PlyElement& vertex) {
    for (std::size_t i = 0; i < vertex.properties.size(); ++i)
      if (!vertex.properties[i].is_list) numbers_.emplace(vertex.properties[i].name, i);
  }
  std::size_t find(const std::string& name) const {
    const auto found = numbers_.find(name);
    return found != numbers_.end() ? found->second : kNone;
  }
  /// Returns the numbers of three properties; an empty list if one is missing.
  std::vector<std::size_t> findAll(const std::array<const char*, 3>& names) const {
    std::vector<std::size_t> found;
    for (const char* const name : names)
      if (const std::size_t number = find(name); number != kNone) found.push_back(number);
    return found.size() == names.size() ? found : std::vector<std::size_t>();
  }

 private:
  std::map<std::string, std::size_t> numbers_;
};

}  // namespace

PlyMeaning meaningOf(const PlyElement& vertex, std::string& error) {
  const PropertyIndex index(vertex);
  PlyMeaning meaning;
  std::vector<std::size_t> axes = index.findAll({"x", "y", "z"});
  if (axes.empty()) axes = index.findAll({"X", "Y", "Z"});
  if (axes.empty()) {
    const auto isMissing = [&](const char* name) { return index.find(name) == kNone; };
    constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
    error =
        "has no property " + quote(*std::find_if(kAxes.begin(), kAxes.end(), isMissing)) + ": a map needs x, y and z";
    return meaning;
  }
  std::copy(axes.begin(), axes.end(), meaning.axes.begin());

  std::vector<std::size_t> colour;
  for (const auto& names : {std::array<const char*, 3>{"red", "green", "blue"},
                            std::array<const char*, 3>{"diffuse_red", "diffuse_green", "diffuse_blue"},
                            std::array<const char*, 3>{"r", "g", "b"}})
    if (colour.empty()) colour = index.findAll(names);

  std::set<std::string> names = {"x", "y", "z"};
  for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
    const PlyProperty& property = vertex.properties[i];
    if (property.is_list || std::find(axes.begin(), axes.end(), i) != axes.end()) continue;
    const auto channel = std::find(colour.begin(), colour.end(), i);
    PlyValue value;
    if (channel != colour.end()) {
      // The colour has the place of its first property.
      if (i != *std::min_element(colour.begin(), colour.end())) continue;
      value = {"rgb", colour};
    } else {
      value = {valueNameOf(property.name), {i}};
    }
    if (names.count(value.name) != 0) value.name = property.name;  // for example intensity and scalar_intensity
    if (names.insert(value.name).second) meaning.values.push_back(std::move(value));
  }
  return meaning;
}

std::vector<double> packColours(const std::array<std::vector<double>, 3>& channels, bool is_float) {
  constexpr double kLargest = 255.0;
  double largest = 0.0;
  for (const std::vector<double>& channel : channels)
    for (const double value : channel) largest = std::max(largest, value);  // NaN does not change it
  const double factor = is_float && largest <= 1.0 ? kLargest : !is_float && largest > kLargest ? 1.0 / 256.0 : 1.0;
  const double rounding = is_float ? 0.5 : 0.0;
  const auto byteOf = [&](double value) {
    const double scaled = std::floor(value * factor + rounding);
    return scaled > 0.0 ? static_cast<std::uint32_t>(std::min(scaled, kLargest)) : 0u;  // NaN: 0
  };
  std::vector<double> colours(channels[0].size());
  for (std::size_t i = 0; i < colours.size(); ++i)
    colours[i] = byteOf(channels[0][i]) << 16 | byteOf(channels[1][i]) << 8 | byteOf(channels[2][i]);
  return colours;
}

}  // namespace gaussmap::detail
