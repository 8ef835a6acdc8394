// SPDX-License-Identifier: BSD-3-Clause
#include "io/las/las_crs.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/files/text.h"
#include "io/las/las_bytes.h"

namespace gaussmap::detail {
namespace {

template <std::size_t N>
bool isOneOf(std::string_view word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool isProjected(std::string_view keyword) {
  constexpr std::array<std::string_view, 3> kWords = {"PROJCS", "PROJCRS", "PROJECTEDCRS"};
  return isOneOf(keyword, kWords);
}
bool isGeographic(std::string_view keyword) {
  constexpr std::array<std::string_view, 3> kWords = {"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"};
  return isOneOf(keyword, kWords);
}
bool isVertical(std::string_view keyword) {
  constexpr std::array<std::string_view, 3> kWords = {"VERT_CS", "VERTCRS", "VERTICALCRS"};
  return isOneOf(keyword, kWords);
}
/// Geodetic systems of WKT 2 can have degrees or geocentric metres: their node CS says which.
bool isGeodetic(std::string_view keyword) {
  constexpr std::array<std::string_view, 3> kWords = {"GEODCRS", "GEODETICCRS", "GEOCCS"};
  return isOneOf(keyword, kWords);
}

/// Reads the nodes KEYWORD[...] of a WKT in one pass. Unbalanced brackets are no error.
class WktParser {
 public:
  explicit WktParser(std::string_view text) : text_(text) {}

  LasCrs parse() {
    for (std::size_t i = 0; i < text_.size();) {
      const char c = text_[i];
      if (c == '[' || c == '(') {
        open_.push_back({word_, 0});
        enter(word_);
      } else if ((c == ']' || c == ')') && !open_.empty()) {
        open_.pop_back();
      } else if (c == ',' && !open_.empty()) {
        ++open_.back().commas;
      } else if (c == '"') {
        const std::size_t end = text_.find('"', i + 1);
        if (end == std::string_view::npos) break;
        i = end;
      } else if (isWordCharacter(c)) {
        const std::size_t first = i;
        while (i < text_.size() && isWordCharacter(text_[i])) ++i;
        take(text_.substr(first, i - first));
        continue;
      }
      ++i;
    }
    if (crs_.is_geographic) crs_.horizontal_unit = 1.0;
    crs_.vertical_unit = vertical_unit_ > 0.0 ? vertical_unit_ : crs_.horizontal_unit;
    return crs_;
  }

 private:
  struct Node {
    std::string keyword;
    std::size_t commas;  // before the current place
  };

  static bool isWordCharacter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
           c == '-' || c == '+';
  }

  /// Takes the keyword of a node that begins. The first system decides: a projected one contains a geographic one.
  void enter(const std::string& keyword) {
    if (has_system_) return;
    has_system_ = isProjected(keyword) || isGeographic(keyword) || isGeodetic(keyword);
    crs_.is_geographic = isGeographic(keyword);
    is_geodetic_ = isGeodetic(keyword);
  }

  void take(std::string_view word) {
    constexpr std::size_t kLongestKeyword = 32;
    word_ = word.substr(0, kLongestKeyword);
    for (char& c : word_) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    if (open_.empty()) return;
    if (is_geodetic_ && open_.back().keyword == "CS" && word_ == "ELLIPSOIDAL") crs_.is_geographic = true;
    const bool is_unit = open_.back().keyword == "UNIT" || open_.back().keyword == "LENGTHUNIT";
    double unit = 0.0;
    if (!is_unit || open_.back().commas != 1 || !parseNumber(word, unit) || !(unit > 0.0)) return;
    std::size_t owner = open_.size() - 1;  // the system that has this unit, itself or at one of its axes
    if (owner > 0 && open_[owner - 1].keyword == "AXIS") --owner;
    if (owner == 0) return;
    const std::string& keyword = open_[owner - 1].keyword;
    if (isProjected(keyword) && !has_unit_) {
      crs_.horizontal_unit = unit;
      has_unit_ = true;
    } else if (isVertical(keyword) && !(vertical_unit_ > 0.0)) {
      vertical_unit_ = unit;
    }
  }

  std::string_view text_;
  std::string word_;  // the last word, in upper case
  std::vector<Node> open_;
  bool has_system_ = false, is_geodetic_ = false, has_unit_ = false;
  double vertical_unit_ = 0.0;
  LasCrs crs_;
};

/// The GeoTIFF keys that are used here.
enum GeoKey : std::uint16_t {
  kModelType = 1024,
  kCitation = 1026,
  kGeographicType = 2048,
  kGeographicCitation = 2049,
  kProjectedType = 3072,
  kProjectedCitation = 3073,
  kProjectedUnits = 3076,
  kVerticalUnits = 4099,
};
constexpr std::uint16_t kUserDefined = 32767;
constexpr std::uint16_t kGeographicModel = 2;

class GeoKeys {
 public:
  GeoKeys(std::string_view directory, std::string_view names) : directory_(directory), names_(names) {}

  /// Returns the number of a key; 0 if the key is missing or is not a number.
  std::uint16_t number(GeoKey wanted) const {
    const char* const entry = find(wanted);
    return entry != nullptr && lasNumber<std::uint16_t>(entry + 2) == 0 ? lasNumber<std::uint16_t>(entry + 6) : 0;
  }
  /// Returns the text of a key; an empty string if the key is missing or is not a text.
  std::string text(GeoKey wanted) const {
    constexpr std::uint16_t kNamesRecord = 34737;
    const char* const entry = find(wanted);
    if (entry == nullptr || lasNumber<std::uint16_t>(entry + 2) != kNamesRecord) return "";
    const std::size_t first = lasNumber<std::uint16_t>(entry + 6);
    if (first > names_.size()) return "";
    std::string_view name = names_.substr(first, lasNumber<std::uint16_t>(entry + 4));
    name = name.substr(0, name.find_first_of(std::string_view("|\0", 2)));  // | ends a name
    std::string printable;
    for (const char c : name) printable += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    return printable;
  }

 private:
  const char* find(GeoKey wanted) const {
    constexpr std::size_t kEntry = 8;  // [bytes], also of the header
    for (std::size_t place = kEntry; place + kEntry <= directory_.size(); place += kEntry)
      if (lasNumber<std::uint16_t>(directory_.data() + place) == wanted) return directory_.data() + place;
    return nullptr;
  }

  std::string_view directory_;
  std::string_view names_;
};

/// Returns the length of a unit of EPSG [m]; 0 if it is another one.
double metresOf(std::uint16_t unit) {
  if (unit == 9001) return 1.0;
  if (unit == 9002) return 0.3048;           // international foot
  if (unit == 9003) return 1200.0 / 3937.0;  // US survey foot
  return 0.0;
}

}  // namespace

LasCrs crsOfWkt(std::string_view wkt) {
  wkt = lasText(wkt);
  LasCrs crs = WktParser(wkt).parse();
  crs.text = wkt;
  return crs;
}

LasCrs crsOfGeoKeys(std::string_view directory, std::string_view names) {
  const GeoKeys keys(directory, names);
  const std::uint16_t model = keys.number(kModelType);
  const std::uint16_t projected = keys.number(kProjectedType), geographic = keys.number(kGeographicType);
  LasCrs crs;
  crs.is_geographic = model == kGeographicModel || (model == 0 && geographic != 0 && projected == 0);
  const std::uint16_t code = crs.is_geographic ? geographic : projected;
  std::string name = keys.text(crs.is_geographic ? kGeographicCitation : kProjectedCitation);
  if (name.empty()) name = keys.text(kCitation);
  if (code != 0 && code != kUserDefined)
    crs.text = "EPSG:" + std::to_string(code) + (name.empty() ? "" : " (" + name + ")");
  if (crs.text.empty()) crs.text = name;
  if (crs.text.empty() && crs.is_geographic) crs.text = "degrees of longitude and latitude";
  if (const double unit = metresOf(keys.number(kProjectedUnits)); unit > 0.0 && !crs.is_geographic)
    crs.horizontal_unit = unit;
  const double vertical = metresOf(keys.number(kVerticalUnits));
  crs.vertical_unit = vertical > 0.0 ? vertical : crs.horizontal_unit;
  return crs;
}

}  // namespace gaussmap::detail
