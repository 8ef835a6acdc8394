// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/point_fields.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

struct Alias {
  std::string_view written;  // in lower case
  std::string_view meaning;
};

// If several columns have the same meaning, the name that stands first in this list wins.
constexpr Alias kAliases[] = {{"x", "x"},
                              {"y", "y"},
                              {"z", "z"},
                              {"points:0", "x"},
                              {"points:1", "y"},
                              {"points:2", "z"},
                              {"points_0", "x"},
                              {"points_1", "y"},
                              {"points_2", "z"},
                              {"points_m_xyz:0", "x"},
                              {"points_m_xyz:1", "y"},
                              {"points_m_xyz:2", "z"},
                              {"easting", "x"},
                              {"northing", "y"},
                              {"elevation", "z"},
                              {"height", "z"},
                              {"intensity", "intensity"},
                              {"i", "intensity"},
                              {"intensities", "intensity"},
                              {"scalar_intensity", "intensity"},
                              {"reflectance", "intensity"},
                              {"reflectivity", "intensity"},
                              {"time", "time"},
                              {"t", "time"},
                              {"timestamp", "time"},
                              {"time_stamp", "time"},
                              {"gps_time", "time"},
                              {"gpstime", "time"},
                              {"offset_time", "time"},
                              {"adjustedtime", "time"},
                              {"ring", "ring"},
                              {"laser_id", "ring"},
                              {"channel", "ring"},
                              {"line", "ring"},
                              {"normal_x", "normal_x"},
                              {"normal_y", "normal_y"},
                              {"normal_z", "normal_z"},
                              {"nx", "normal_x"},
                              {"ny", "normal_y"},
                              {"nz", "normal_z"},
                              {"normals:0", "normal_x"},
                              {"normals:1", "normal_y"},
                              {"normals:2", "normal_z"},
                              {"curvature", "curvature"},
                              {"label", "label"},
                              {"class", "label"},
                              {"classification", "label"},
                              {"rgb", "rgb"},
                              {"rgba", "rgb"},
                              {"red", "red"},
                              {"green", "green"},
                              {"blue", "blue"},
                              {"r", "red"},
                              {"g", "green"},
                              {"b", "blue"},
                              {"rf", "red"},
                              {"gf", "green"},
                              {"bf", "blue"}};
constexpr std::size_t kAliasCount = std::size(kAliases);

struct Unit {
  std::string_view written;
  double divisor;
};
constexpr Unit kLengths[] = {{"m", 1},      {"meter", 1}, {"meters", 1}, {"metre", 1},
                             {"metres", 1}, {"cm", 100},  {"mm", 1000},  {"km", 1e-3}};
constexpr Unit kTimes[] = {{"s", 1}, {"sec", 1}, {"ms", 1e3}, {"us", 1e6}, {"\xC2\xB5s", 1e6}, {"ns", 1e9}};

constexpr std::pair<std::string_view, NumberType> kTypes[] = {
    {"f32", NumberType::Float32}, {"f64", NumberType::Float64}, {"u8", NumberType::UInt8},  {"u16", NumberType::UInt16},
    {"u32", NumberType::UInt32},  {"i8", NumberType::Int8},     {"i16", NumberType::Int16}, {"i32", NumberType::Int32}};

/// Returns the place of a name in kAliases, or kAliasCount.
std::size_t aliasOf(std::string_view lower) {
  const auto* const found = std::find_if(std::begin(kAliases), std::end(kAliases),
                                         [&](const Alias& alias) { return alias.written == lower; });
  return static_cast<std::size_t>(found - std::begin(kAliases));
}

bool isCoordinate(std::string_view name) {
  return name == "x" || name == "y" || name == "z";
}

/// Returns the divisor of a unit for a field with this meaning, or 0 if the unit is unknown.
double divisorOf(std::string_view meaning, std::string_view unit) {
  const auto find = [&](const auto& units) {
    for (const Unit& known : units)
      if (known.written == unit) return known.divisor;
    return 0.0;
  };
  return isCoordinate(meaning) ? find(kLengths) : meaning == "time" ? find(kTimes) : 0.0;
}

/// A name of a header, split into the name and the unit: "x [m]", "X(m)", "time_ns".
struct SplitName {
  std::string_view name;
  std::string unit;                 // in lower case
  std::size_t alias = kAliasCount;  // place in kAliases
};

SplitName splitName(std::string_view written) {
  written = trimmed(written);
  SplitName split{written, "", aliasOf(lowerCase(written))};
  if (written.empty() || split.alias != kAliasCount) return split;
  const char close = written.back();
  if (close == ']' || close == ')') {
    const std::size_t open = written.rfind(close == ']' ? '[' : '(');
    if (open == std::string_view::npos) return split;
    split.name = trimmed(written.substr(0, open));
    split.unit = lowerCase(trimmed(written.substr(open + 1, written.size() - open - 2)));
    split.alias = aliasOf(lowerCase(split.name));
    return split;
  }
  const std::size_t bar = written.rfind('_');
  if (bar == std::string_view::npos) return split;
  const std::size_t alias = aliasOf(lowerCase(written.substr(0, bar)));
  const std::string unit = lowerCase(written.substr(bar + 1));
  if (alias == kAliasCount || divisorOf(kAliases[alias].meaning, unit) == 0.0) return split;
  return {written.substr(0, bar), unit, alias};
}

[[noreturn]] void failInList(std::string_view item, const std::string& what) {
  throw std::invalid_argument("fields: " + quote(item) + " " + what);
}

PointField parseField(std::string_view item, bool with_types) {
  PointField field;
  std::string_view rest = item;
  const auto next = [&] {
    const std::size_t colon = rest.find(':');
    const std::string_view part = rest.substr(0, colon);
    rest.remove_prefix(colon == std::string_view::npos ? rest.size() : colon + 1);
    return part;
  };
  const std::string_view name = next();
  if (name.empty()) failInList(item, "has no name");
  if (name != "-") {
    const std::size_t alias = aliasOf(lowerCase(name));
    field.name = alias == kAliasCount ? std::string(name) : std::string(kAliases[alias].meaning);
  }
  bool has_type = false;
  while (!rest.empty() || item.back() == ':') {
    const std::string_view part = next();
    const auto* const type =
        std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& known) { return known.first == part; });
    const bool is_type = type != std::end(kTypes);
    const double divisor = is_type ? 0.0 : divisorOf(field.name, lowerCase(part));
    if (is_type && !with_types) failInList(item, "has a type, but the columns of a text have none");
    if (!is_type && divisor == 0.0)
      failInList(item, "ends in " + quote(part) + ", which is not a unit of this field" +
                           (with_types ? " and not a type (f32 f64 u8 u16 u32 i8 i16 i32)" : "") +
                           "; units are m cm mm for x y z and s ms us ns for time");
    if (is_type ? has_type : field.has_unit) failInList(item, is_type ? "has two types" : "has two units");
    if (is_type) {
      field.type = type->second;
      has_type = true;
    } else {
      field.divisor = divisor;
      field.has_unit = true;
    }
    if (rest.empty()) break;
  }
  if (isCoordinate(field.name) && isWhole(field.type) && !field.has_unit)
    failInList(item, "is a whole number without a unit: write for example " + field.name + ":i32:mm");
  return field;
}

}  // namespace

std::size_t indexOf(const std::vector<PointField>& fields, std::string_view name) {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const PointField& field) { return field.name == name; });
  return static_cast<std::size_t>(found - fields.begin());
}

std::vector<PointField> parseFields(std::string_view text, bool with_types) {
  constexpr std::size_t kMostFields = 1000;
  std::string words(text);
  std::replace(words.begin(), words.end(), ',', ' ');
  std::replace(words.begin(), words.end(), '\n', ' ');
  std::vector<PointField> fields;
  std::set<std::string> seen;
  const std::vector<std::string_view> items = splitWords(words);
  for (const std::string_view item : items) {
    fields.push_back(parseField(item, with_types));
    const std::string& name = fields.back().name;
    if (!name.empty() && !seen.insert(name).second) failInList(item, "occurs twice");
    if (fields.size() > kMostFields) throw std::invalid_argument("fields: more than 1000 fields");
  }
  // A single r or b is not a colour. It can be a range or anything.
  const bool has_colours = std::all_of(std::begin(kColourChannels), std::end(kColourChannels),
                                       [&](const char* channel) { return seen.count(channel) > 0; });
  for (std::size_t i = 0; !has_colours && i < fields.size(); ++i)
    if (std::find(std::begin(kColourChannels), std::end(kColourChannels), fields[i].name) != std::end(kColourChannels))
      fields[i].name = items[i].substr(0, items[i].find(':'));
  for (const char* const name : {"x", "y", "z"})
    if (seen.count(name) == 0)
      throw std::invalid_argument("fields: no " + quote(name) + ": a scan needs x, y and z, as in \"x y z intensity\"");
  return fields;
}

NamedColumns nameColumns(const std::vector<std::string_view>& names) {
  NamedColumns named;
  std::vector<SplitName> split;
  std::map<std::string_view, std::size_t> winners;  // meaning: column
  for (std::size_t i = 0; i < names.size(); ++i) {
    split.push_back(splitName(names[i]));
    if (split[i].alias == kAliasCount) continue;
    const std::string_view meaning = kAliases[split[i].alias].meaning;
    const auto [winner, is_first] = winners.emplace(meaning, i);
    if (is_first) continue;
    if (split[i].alias == split[winner->second].alias && isCoordinate(meaning) && named.fault.empty())
      named.fault = "two columns are named " + quote(names[i]);
    if (split[i].alias < split[winner->second].alias) winner->second = i;
  }
  const auto has = [&](std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  if (has("cov_xx") && has("cell_side")) named.fault = "the rows are the Gaussians of a map, not the points of a scan";
  // A single r is not a colour. It can be a range or a ring.
  const bool has_colours = std::all_of(std::begin(kColourChannels), std::end(kColourChannels),
                                       [&](const char* channel) { return winners.count(channel) > 0; });
  std::set<std::string> used;
  for (const auto& [meaning, column] : winners) used.insert(std::string(meaning));
  for (std::size_t i = 0; i < names.size(); ++i) {
    PointField field;
    const std::string_view meaning = split[i].alias == kAliasCount ? "" : kAliases[split[i].alias].meaning;
    const bool is_channel =
        std::find(std::begin(kColourChannels), std::end(kColourChannels), meaning) != std::end(kColourChannels);
    if (!meaning.empty() && winners.at(meaning) == i && (has_colours || !is_channel)) {
      field.name = meaning;
      const double divisor = divisorOf(meaning, split[i].unit);
      if (divisor != 0.0) field.divisor = divisor;
      field.has_unit = divisor != 0.0;
      if (isCoordinate(meaning) && divisor == 0.0 && !split[i].unit.empty() && named.fault.empty())
        named.fault = "the unit of " + quote(names[i]) + " is unknown; convert the coordinates to metres";
    } else {
      const std::string name(split[i].name);
      field.name = name;
      for (int number = 2; !name.empty() && !used.insert(field.name).second; ++number)
        field.name = name + "_" + std::to_string(number);
    }
    named.fields.push_back(std::move(field));
  }
  return named;
}

bool namesCoordinates(const std::vector<std::string_view>& names) {
  bool found[3] = {false, false, false};
  for (const std::string_view name : names) {
    const SplitName split = splitName(name);
    if (split.alias == kAliasCount || !isCoordinate(kAliases[split.alias].meaning)) continue;
    found[kAliases[split.alias].meaning.front() - 'x'] = true;
  }
  return found[0] && found[1] && found[2];
}

}  // namespace gaussmap::detail
