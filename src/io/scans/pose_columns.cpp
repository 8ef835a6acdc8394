// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/pose_columns.h"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <utility>

namespace gaussmap::detail {
namespace {

using Words = std::vector<std::string>;

constexpr const char* kNoUnit =
    "the unit of roll, pitch and yaw is not stated; use --pose-format xyzrpy-deg or xyzrpy-rad";

bool isAmong(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool anyAmong(const Words& parts, std::initializer_list<const char*> words) {
  return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) { return isAmong(part, words); });
}

/// Lower case, without the marks of comments, and with units in brackets tied to their name: "x [m]" -> "x[m]".
std::string plainHeader(std::string_view header) {
  std::string text;
  int depth = 0;
  for (const char c : header) {
    const bool blank = c == ' ' || c == '\t' || c == '\r';
    if (c == '"' || c == '\'' || ((c == '#' || c == '%') && text.find_first_not_of(' ') == std::string::npos)) continue;
    if (c == '[' || c == '(') {
      while (!text.empty() && text.back() == ' ') text.pop_back();
      ++depth;
    }
    if (blank && depth > 0) {
      text += '_';
    } else if (blank) {
      text += ' ';
    } else {
      text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    if ((c == ']' || c == ')') && depth > 0) --depth;
  }
  return text;
}

Words namesIn(std::string_view header) {
  const std::string text = plainHeader(header);
  const char separator = text.find(';') != std::string::npos ? ';' : text.find(',') != std::string::npos ? ',' : ' ';
  Words names;
  std::string name;
  const auto end = [&] {
    const std::size_t first = name.find_first_not_of(' '), last = name.find_last_not_of(' ');
    if (separator != ' ' || first != std::string::npos)
      names.push_back(first == std::string::npos ? "" : name.substr(first, last - first + 1));
    name.clear();
  };
  for (const char c : text) {
    if (c == separator)
      end();
    else
      name += c;
  }
  end();
  while (!names.empty() && names.back().empty()) names.pop_back();  // a separator at the end of the line
  return names;
}

/// A name of a column in parts: "p_RS_R_x [m]" -> p rs r x, unit m.
struct ColumnName {
  Words parts;
  std::string unit, joined;
};

ColumnName splitName(const std::string& text) {
  ColumnName name;
  const std::size_t bracket = std::min(text.find('['), text.find('('));
  if (bracket != std::string::npos) {
    const std::size_t end = text.find_first_of("])", bracket);
    name.unit = text.substr(bracket + 1, end == std::string::npos ? end : end - bracket - 1);
  }
  std::string part;
  for (const char c : text.substr(0, bracket) + "_") {
    if (c == '_' || c == '.' || c == ' ' || c == '-' || c == '/' || c == ':') {
      if (!part.empty()) name.parts.push_back(std::exchange(part, ""));
    } else {
      part += c;
    }
  }
  const auto isUnit = [](const std::string& word) {
    return isAmong(word, {"s",    "sec",   "secs",    "seconds",  "ms",   "us",     "ns",
                          "nsec", "nsecs", "nanosec", "nanosecs", "usec", "msec",   "nanoseconds",
                          "m",    "deg",   "degree",  "degrees",  "rad",  "radian", "radians"});
  };
  if (name.parts.size() > 1 && isUnit(name.parts.back())) {
    if (name.unit.empty()) name.unit = name.parts.back();
    name.parts.pop_back();
  }
  for (const std::string& one : name.parts) name.joined += one;
  return name;
}

std::optional<TimeUnit> timeUnitOf(const std::string& unit) {
  if (isAmong(unit, {"s", "sec", "secs", "second", "seconds"})) return TimeUnit::Seconds;
  if (isAmong(unit, {"ms", "msec", "milliseconds"})) return TimeUnit::Milliseconds;
  if (isAmong(unit, {"us", "usec", "microseconds"})) return TimeUnit::Microseconds;
  if (isAmong(unit, {"ns", "nsec", "nsecs", "nanosec", "nanosecs", "nanos", "nanoseconds"}))
    return TimeUnit::Nanoseconds;
  return std::nullopt;
}

bool isDegrees(const std::string& unit) {
  return isAmong(unit, {"deg", "degree", "degrees", "\xC2\xB0"});
}

/// The role of a column, and for matrices the two digits of the element as written.
struct Role {
  PoseColumn column = PoseColumn::Skip;
  int row = -1, element = -1;
};

/// Roles that the whole name gives.
std::optional<PoseColumn> plainRole(const ColumnName& name) {
  const std::string& n = name.joined;
  if (timeUnitOf(n) && name.parts.size() == 1 && n != "s") return PoseColumn::Time;
  if (anyAmong(name.parts, {"time", "timestamp", "stamp"}) && anyAmong(name.parts, {"index", "idx", "id", "name"}))
    return PoseColumn::Key;
  if (anyAmong(name.parts, {"time", "timestamp", "timestamps", "stamp", "stamps", "utime", "epoch"}) ||
      isAmong(n, {"t", "ts", "unixtime"}))
    return PoseColumn::Time;
  if (isAmong(n, {"index",  "idx",  "id",       "num",     "number",      "seq",           "i",
                  "no",     "nr",   "scanid",   "frameid", "framenumber", "frameindex",    "scanindex",
                  "nodeid", "node", "keyframe", "kf",      "headerseq",   "fieldheaderseq"}))
    return PoseColumn::Index;
  if (isAmong(n, {"frame", "scan", "key"})) return PoseColumn::Key;
  if (isAmong(n, {"name", "file", "filename", "path", "scanname", "pcd", "cloud", "image", "imagename"}))
    return PoseColumn::Name;
  const std::string last = name.parts.empty() ? "" : name.parts.back();
  if (last == "roll") return PoseColumn::Roll;
  if (last == "pitch") return PoseColumn::Pitch;
  if (last == "yaw") return PoseColumn::Yaw;
  return std::nullopt;
}

Role roleOf(const ColumnName& name) {
  if (name.parts.empty()) return {};
  if (anyAmong(name.parts, {"v",     "vel",    "velocity", "lin",          "linear",  "ang",        "angular",
                            "twist", "acc",    "accel",    "acceleration", "gyro",    "bias",       "ba",
                            "bg",    "bw",     "b",        "omega",        "cov",     "covariance", "sigma",
                            "std",   "stddev", "var",      "variance",     "gravity", "err",        "error"}))
    return {};
  if (const std::optional<PoseColumn> role = plainRole(name)) return {*role};
  const std::string& n = name.joined;
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  if (n.size() >= 3 && isDigit(n[n.size() - 1]) && isDigit(n[n.size() - 2]) &&
      isAmong(n.substr(0, n.size() - 2), {"r", "m", "t", "p", "rot", "mat", "pose", "matrix"}))
    return {PoseColumn::M11, n[n.size() - 2] - '0', n[n.size() - 1] - '0'};
  if (isAmong(n, {"q0", "q1", "q2", "q3"})) {
    constexpr PoseColumn kNumbered[] = {PoseColumn::QW, PoseColumn::QX, PoseColumn::QY, PoseColumn::QZ};
    return {kNumbered[n[1] - '0']};
  }
  const char axis = n.back();
  if (axis != 'x' && axis != 'y' && axis != 'z' && axis != 'w') return {};
  Words before = name.parts;  // the name without its axis
  before.back().pop_back();
  if (before.back().empty()) before.pop_back();
  if (anyAmong(before, {"q", "quat", "quaternion", "orientation", "ori", "rot", "rotation", "attitude", "att"})) {
    return {axis == 'w'   ? PoseColumn::QW
            : axis == 'x' ? PoseColumn::QX
            : axis == 'y' ? PoseColumn::QY
                          : PoseColumn::QZ};
  }
  const bool is_position = before.empty() || anyAmong(before, {"t", "p", "pos", "position", "trans", "translation",
                                                               "pose", "location", "loc"});
  if (!is_position || axis == 'w') return {};
  return {axis == 'x' ? PoseColumn::X : axis == 'y' ? PoseColumn::Y : PoseColumn::Z};
}

bool hasAll(const PoseLayout& layout, std::initializer_list<PoseColumn> columns) {
  return std::all_of(columns.begin(), columns.end(), [&](PoseColumn column) { return layout.has(column); });
}

/// Sets the elements of the matrix, whose rows and columns the names count from 0 or from 1.
void setMatrix(const std::vector<Role>& roles, PoseLayout& layout) {
  if (std::none_of(roles.begin(), roles.end(), [](const Role& role) { return role.row >= 0; })) return;
  bool from_zero = false;
  for (const Role& role : roles) from_zero = from_zero || role.row == 0 || role.element == 0;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i].row < 0) continue;
    const int row = roles[i].row - (from_zero ? 0 : 1), element = roles[i].element - (from_zero ? 0 : 1);
    layout.columns[i] =
        row >= 0 && row < 3 && element >= 0 && element < 4 ? matrixColumn(4 * row + element) : PoseColumn::Skip;
  }
  for (const auto& [axis, element] : {std::pair(PoseColumn::X, 3), {PoseColumn::Y, 7}, {PoseColumn::Z, 11}}) {
    const PoseColumn column = matrixColumn(element);
    if (!layout.has(column)) std::replace(layout.columns.begin(), layout.columns.end(), axis, column);
  }
}

bool hasMatrix(const PoseLayout& layout) {
  for (int i = 0; i < 12; ++i)
    if (!layout.has(matrixColumn(i))) return false;
  return true;
}

/// Two columns of time are seconds and nanoseconds, or the first one counts. Returns the unit of the time.
std::optional<TimeUnit> pairTimes(const std::vector<ColumnName>& names, PoseLayout& layout) {
  std::vector<std::size_t> times;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (layout.columns[i] == PoseColumn::Time) times.push_back(i);
  if (times.empty()) return std::nullopt;
  const bool is_euroc = std::any_of(names.begin(), names.end(),
                                    [](const ColumnName& name) { return name.joined.compare(0, 4, "prsr") == 0; });
  const auto unitOfColumn = [&](std::size_t i) {
    if (names[i].joined == "utime") return std::optional(TimeUnit::Microseconds);
    if (is_euroc) return std::optional(TimeUnit::Nanoseconds);
    return timeUnitOf(names[i].unit.empty() ? names[i].joined : names[i].unit);
  };
  if (times.size() == 2 && unitOfColumn(times[0]) == TimeUnit::Seconds &&
      unitOfColumn(times[1]) == TimeUnit::Nanoseconds) {
    layout.columns[times[0]] = PoseColumn::Seconds;
    layout.columns[times[1]] = PoseColumn::Nanoseconds;
    return TimeUnit::Seconds;
  }
  std::size_t kept = times.front();
  for (const std::size_t i : times)
    if (anyAmong(names[i].parts, {"header", "stamp"})) kept = i;
  for (const std::size_t i : times)
    if (i != kept) layout.columns[i] = PoseColumn::Skip;
  return unitOfColumn(kept);
}

std::string problemOf(const PoseLayout& layout, const std::vector<ColumnName>& names) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (layout.columns[i] != PoseColumn::Skip && layout.columns[i] == layout.columns[j])
        return "columns " + std::to_string(j + 1) + " and " + std::to_string(i + 1) + " have the same meaning";
  if (layout.rotation == RotationKind::Matrix) return "";
  if (!hasAll(layout, {PoseColumn::X, PoseColumn::Y, PoseColumn::Z})) return "no columns x, y and z";
  if (hasAll(layout, {PoseColumn::QX, PoseColumn::QY, PoseColumn::QZ, PoseColumn::QW})) return "";
  if (!hasAll(layout, {PoseColumn::Roll, PoseColumn::Pitch, PoseColumn::Yaw}))
    return "no columns qx, qy, qz and qw, nor roll, pitch and yaw, nor r11 to r33";
  for (std::size_t i = 0; i < names.size(); ++i)
    if (layout.columns[i] == PoseColumn::Roll && !isDegrees(names[i].unit) &&
        !isAmong(names[i].unit, {"rad", "radian", "radians"}))
      return kNoUnit;
  return "";
}

}  // namespace

bool PoseLayout::has(PoseColumn column) const {
  return std::find(columns.begin(), columns.end(), column) != columns.end();
}

std::string PoseLayout::text() const {
  static const std::map<PoseColumn, const char*> kTexts = {{PoseColumn::Skip, "-"},
                                                           {PoseColumn::Key, "key"},
                                                           {PoseColumn::Name, "name"},
                                                           {PoseColumn::Index, "index"},
                                                           {PoseColumn::Time, "time"},
                                                           {PoseColumn::Seconds, "sec"},
                                                           {PoseColumn::Nanoseconds, "nsec"},
                                                           {PoseColumn::X, "x"},
                                                           {PoseColumn::Y, "y"},
                                                           {PoseColumn::Z, "z"},
                                                           {PoseColumn::QX, "qx"},
                                                           {PoseColumn::QY, "qy"},
                                                           {PoseColumn::QZ, "qz"},
                                                           {PoseColumn::QW, "qw"},
                                                           {PoseColumn::Roll, "roll"},
                                                           {PoseColumn::Pitch, "pitch"},
                                                           {PoseColumn::Yaw, "yaw"}};
  std::string text;
  const auto add = [&](const std::string& word) { text += (text.empty() ? "" : " ") + word; };
  bool matrix = false;
  for (const PoseColumn column : columns) {
    const auto found = kTexts.find(column);
    if (found != kTexts.end()) {
      add(found->second);
    } else if (!matrix) {
      add("3 x 4 matrix");
      matrix = true;
    }
  }
  while (text.size() >= 2 && text.compare(text.size() - 2, 2, " -") == 0) text.resize(text.size() - 2);
  if (rotation == RotationKind::RollPitchYaw) text += degrees ? " in degrees" : " in radians";
  return text;
}

NamedLayout layoutOfNames(std::string_view header) {
  std::vector<ColumnName> names;
  for (const std::string& name : namesIn(header)) names.push_back(splitName(name));
  std::vector<Role> roles;
  PoseLayout layout;
  for (const ColumnName& name : names) {
    roles.push_back(roleOf(name));
    layout.columns.push_back(roles.back().column);
  }
  setMatrix(roles, layout);
  layout.unit = pairTimes(names, layout);
  const bool is_quaternion = hasAll(layout, {PoseColumn::QX, PoseColumn::QY, PoseColumn::QZ, PoseColumn::QW});
  layout.rotation = hasMatrix(layout) ? RotationKind::Matrix
                    : is_quaternion   ? RotationKind::Quaternion
                                      : RotationKind::RollPitchYaw;
  // What is written twice counts once: the quaternion wins over angles, a matrix over both.
  for (PoseColumn& column : layout.columns) {
    const bool is_angle = column == PoseColumn::Roll || column == PoseColumn::Pitch || column == PoseColumn::Yaw;
    const bool is_number = column >= PoseColumn::X && column <= PoseColumn::Yaw;
    if ((layout.rotation == RotationKind::Quaternion && is_angle) ||
        (layout.rotation == RotationKind::Matrix && is_number) ||
        (layout.rotation != RotationKind::Matrix && column >= PoseColumn::M11))
      column = PoseColumn::Skip;
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    if (layout.columns[i] == PoseColumn::Roll) layout.degrees = isDegrees(names[i].unit);
  const bool has_key = std::any_of(layout.columns.begin(), layout.columns.end(), [](PoseColumn column) {
    return column != PoseColumn::Skip && column < PoseColumn::X;
  });
  if (!has_key && layout.columns.size() > 7 && layout.columns.front() == PoseColumn::Skip)
    layout.columns.front() = PoseColumn::Key;
  NamedLayout result;
  result.problem = problemOf(layout, names);
  result.lacks_unit = result.problem == kNoUnit;
  if (result.problem.empty() || result.lacks_unit) result.layout = std::move(layout);
  return result;
}

std::size_t countNames(std::string_view header) {
  return namesIn(header).size();
}

}  // namespace gaussmap::detail
