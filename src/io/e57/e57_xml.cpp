// SPDX-License-Identifier: BSD-3-Clause
#include "io/e57/e57_xml.h"

#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <pugixml.hpp>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "gaussmap/core/error.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

/// Returns a text for messages and tables: without control characters, on one line, at most 80 bytes of whole UTF-8
/// characters.
std::string onOneLine(std::string_view text) {
  constexpr std::size_t kLongest = 80;
  std::string line;
  text = trimmed(text);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool starts_character = (byte & 0xC0u) != 0x80u;
    if (line.size() >= kLongest && starts_character) {
      line += "...";
      break;
    }
    if (line.size() >= kLongest + 4) break;  // not UTF-8
    const bool is_c1_control = byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (is_c1_control) ++i;
    line += byte < 0x20 || byte == 0x7F || is_c1_control ? ' ' : text[i];
  }
  return line;
}

class E57XmlReader {
 public:
  explicit E57XmlReader(const std::filesystem::path& path) : path_(path) {}

  E57Description read(std::string& xml) {
    // The parser takes UTF-8 only, as the standard asks for, and knows no entities but those of XML itself.
    pugi::xml_document document;
    const pugi::xml_parse_result result =
        document.load_buffer_inplace(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result)
      throw FileError(path_, "the XML section is damaged at its byte " + std::to_string(result.offset) + ": " +
                                 onOneLine(result.description()));
    const pugi::xml_node root = document.child("e57Root");
    if (!root) throw FileError(path_, "the XML section has no element e57Root");
    E57Description description;
    description.coordinate_system = root.child("coordinateMetadata").text().get();
    const auto images = root.child("images2D").children();
    description.images = static_cast<std::size_t>(std::distance(images.begin(), images.end()));
    for (const pugi::xml_node scan : root.child("data3D").children()) {
      scan_ = description.scans.size();
      description.scans.push_back(readScan(scan));
    }
    return description;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw FileError(path_, e57Place(scan_) + what); }

  template <typename T>
  T number(std::string_view text, const std::string& what) const {
    const std::string_view word = trimmed(text);
    T value = 0;
    const char* const last = word.data() + word.size();
    const char* first = word.data();
    if (word.size() > 1 && *first == '+' && first[1] != '-') ++first;
    const auto [end, error] = std::from_chars(first, last, value);
    if (error == std::errc() && end == last) return value;
    constexpr const char* kKind = std::is_floating_point_v<T> ? "a number"
                                  : std::is_signed_v<T>       ? "an integer of 64 bits"
                                                              : "a whole number >= 0";
    fail(what + " is " + quote(word) + ", not " + kKind);
  }

  /// Returns the number of an element of the type Float, Integer or ScaledInteger. An empty element is zero.
  double valueOf(const pugi::xml_node& node, const std::string& what) const {
    const std::string_view text = trimmed(node.text().get());
    double value = text.empty() ? 0.0 : number<double>(text, what);
    if (std::string_view(node.attribute("type").value()) == "ScaledInteger")
      value = value * attribute(node, "scale", 1.0, what) + attribute(node, "offset", 0.0, what);
    return value;
  }

  double childValue(const pugi::xml_node& parent, const char* name, const std::string& what) const {
    const pugi::xml_node node = parent.child(name);
    if (!node) fail("the " + what + " has no element " + name);
    return valueOf(node, what + "/" + name);
  }

  template <typename T>
  T attribute(const pugi::xml_node& node, const char* name, T missing, const std::string& what) const {
    const pugi::xml_attribute found = node.attribute(name);
    return found ? number<T>(found.value(), "the " + std::string(name) + " of " + what) : missing;
  }

  E57Scan readScan(const pugi::xml_node& node) const {
    E57Scan scan;
    scan.name = onOneLine(node.child("name").text().get());
    if (scan.name.empty()) scan.name = onOneLine(node.child("guid").text().get());
    scan.pose = readPose(node.child("pose"));
    scan.time = readTime(node.child("acquisitionStart"));
    readColourLimits(node.child("colorLimits"), scan);
    const pugi::xml_node points = node.child("points");
    if (!points) fail("has no element points");
    if (const std::string_view type = points.attribute("type").value(); type != "CompressedVector")
      fail("the points have the type " + quote(type) + ", expected CompressedVector");
    for (const char* const name : {"fileOffset", "recordCount"})
      if (!points.attribute(name)) fail("the points have no attribute " + std::string(name));
    scan.section = attribute<std::uint64_t>(points, "fileOffset", 0, "the points");
    scan.points = attribute<std::uint64_t>(points, "recordCount", 0, "the points");
    readFields(points.child("prototype"), scan);
    checkCodecs(points.child("codecs"));
    return scan;
  }

  std::optional<Pose> readPose(const pugi::xml_node& node) const {
    const pugi::xml_node rotation = node.child("rotation"), translation = node.child("translation");
    if (!rotation && !translation) return std::nullopt;
    Pose pose;
    if (rotation) {
      const std::string what = "pose/rotation";
      const double w = childValue(rotation, "w", what), x = childValue(rotation, "x", what);
      const double y = childValue(rotation, "y", what), z = childValue(rotation, "z", what);
      pose.rotation = Pose::Rotation(w, x, y, z);
    }
    if (translation) {
      const std::string what = "pose/translation";
      pose.translation[0] = childValue(translation, "x", what);
      pose.translation[1] = childValue(translation, "y", what);
      pose.translation[2] = childValue(translation, "z", what);
    }
    return pose;
  }

  std::optional<std::chrono::nanoseconds> readTime(const pugi::xml_node& node) const {
    const pugi::xml_node value = node.child("dateTimeValue");
    if (!value) return std::nullopt;
    const double seconds = valueOf(value, "acquisitionStart/dateTimeValue");
    constexpr double kLargest = 9.2e9;  // 64 bits of nanoseconds
    if (!(seconds > 0.0 && seconds < kLargest)) return std::nullopt;
    const double whole = std::floor(seconds);
    return std::chrono::seconds(static_cast<std::int64_t>(whole)) +
           std::chrono::nanoseconds(std::llround((seconds - whole) * 1e9));
  }

  void readColourLimits(const pugi::xml_node& node, E57Scan& scan) const {
    constexpr const char* kNames[3][2] = {{"colorRedMinimum", "colorRedMaximum"},
                                          {"colorGreenMinimum", "colorGreenMaximum"},
                                          {"colorBlueMinimum", "colorBlueMaximum"}};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!node.child(kNames[i][0]) || !node.child(kNames[i][1])) continue;
      scan.colour_limits[i] =
          E57Limits{childValue(node, kNames[i][0], "colorLimits"), childValue(node, kNames[i][1], "colorLimits")};
    }
  }

  void readFields(const pugi::xml_node& prototype, E57Scan& scan) const {
    if (!prototype) fail("the points have no prototype");
    std::set<std::string_view> names;
    for (const pugi::xml_node node : prototype.children()) {
      if (!names.insert(node.name()).second) fail("the points have two fields " + quote(node.name()));
      scan.fields.push_back(readField(node));
    }
    // The number of fields in a packet has 16 bits.
    if (scan.fields.size() > std::numeric_limits<std::uint16_t>::max())
      fail("the points have " + std::to_string(scan.fields.size()) + " fields, at most 65535 are possible");
  }

  E57Field readField(const pugi::xml_node& node) const {
    E57Field field;
    field.name = node.name();
    const std::string what = "field " + quote(field.name);
    const std::string_view type = node.attribute("type").value();
    if (type == "Float") {
      const std::string_view precision = node.attribute("precision").value();
      if (precision == "single")
        field.encoding = E57Encoding::Single;
      else if (!precision.empty() && precision != "double")
        fail("the precision of " + what + " is " + quote(precision) + ", expected single or double");
    } else if (type == "Integer" || type == "ScaledInteger") {
      field.encoding = type == "Integer" ? E57Encoding::Integer : E57Encoding::ScaledInteger;
      field.minimum = attribute(node, "minimum", std::numeric_limits<std::int64_t>::min(), what);
      field.maximum = attribute(node, "maximum", std::numeric_limits<std::int64_t>::max(), what);
      if (field.minimum > field.maximum)
        fail("the minimum of " + what + " is " + std::to_string(field.minimum) + ", greater than its maximum " +
             std::to_string(field.maximum));
      if (type == "ScaledInteger") readScale(node, what, field);
    } else if (type == "String") {
      field.encoding = E57Encoding::String;
    } else {
      fail(what + " has the type " + quote(type) + ", expected Integer, ScaledInteger, Float or String");
    }
    return field;
  }

  void readScale(const pugi::xml_node& node, const std::string& what, E57Field& field) const {
    field.scale = attribute(node, "scale", 1.0, what);
    field.offset = attribute(node, "offset", 0.0, what);
    if (!std::isfinite(field.scale) || field.scale == 0.0 || !std::isfinite(field.offset))
      fail("the scale of " + what + " is " + quote(node.attribute("scale").value()) + " and its offset " +
           quote(node.attribute("offset").value()) + ", expected finite numbers and a scale other than 0");
  }

  /// Only one codec exists, and it is also the one of fields that no entry names.
  void checkCodecs(const pugi::xml_node& codecs) const {
    for (const pugi::xml_node entry : codecs.children())
      for (const pugi::xml_node part : entry.children())
        if (const std::string_view name = part.name(); name != "inputs" && name != "bitPackCodec")
          fail("the codec " + quote(name) + " is unknown, expected bitPackCodec");
  }

  const std::filesystem::path& path_;
  std::size_t scan_ = 0;
};

}  // namespace

std::string e57Place(std::size_t scan) {
  return "scan " + std::to_string(scan) + ": ";
}

E57Description parseE57Xml(const std::filesystem::path& path, std::string xml) {
  return E57XmlReader(path).read(xml);
}

}  // namespace gaussmap::detail
