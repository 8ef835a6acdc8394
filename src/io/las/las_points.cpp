// SPDX-License-Identifier: BSD-3-Clause
#include "io/las/las_points.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>
#include <string_view>
#include <type_traits>

#include "io/las/las_bytes.h"

namespace gaussmap::detail {
namespace {

using Kind = LasField::Kind;

constexpr int kColourBits = 16;
constexpr std::uint64_t kChannel = 0xFFFF;

LasField fieldAt(std::size_t offset, Kind kind, const char* name) {
  LasField field;
  field.name = name;
  field.kind = kind;
  field.offset = offset;
  return field;
}

LasField bitsAt(std::size_t offset, int shift, std::uint8_t mask, const char* name) {
  LasField field = fieldAt(offset, Kind::Bits, name);
  field.shift = shift;
  field.mask = mask;
  return field;
}

/// Formats 0 to 5.
std::vector<LasField> oldFields(int format) {
  std::vector<LasField> fields = {fieldAt(12, Kind::UInt16, "intensity"), bitsAt(14, 0, 7, "return_number"),
                                  bitsAt(14, 3, 7, "number_of_returns"),  bitsAt(15, 0, 31, "classification"),
                                  bitsAt(15, 7, 1, "withheld"),           fieldAt(16, Kind::Int8, "scan_angle"),
                                  fieldAt(17, Kind::UInt8, "user_data"),  fieldAt(18, Kind::UInt16, "point_source_id")};
  const bool has_time = format == 1 || format >= 3;
  if (has_time) fields.push_back(fieldAt(20, Kind::Double, "time"));
  if (format == 2 || format == 3 || format == 5) fields.push_back(fieldAt(has_time ? 28 : 20, Kind::Colour, "rgb"));
  return fields;
}

/// Formats 6 to 10.
std::vector<LasField> newFields(int format) {
  std::vector<LasField> fields = {fieldAt(12, Kind::UInt16, "intensity"), bitsAt(14, 0, 15, "return_number"),
                                  bitsAt(14, 4, 15, "number_of_returns"), fieldAt(16, Kind::UInt8, "classification"),
                                  bitsAt(15, 2, 1, "withheld"),           bitsAt(15, 3, 1, "overlap"),
                                  bitsAt(15, 4, 3, "scanner_channel"),    fieldAt(18, Kind::Int16, "scan_angle"),
                                  fieldAt(17, Kind::UInt8, "user_data"),  fieldAt(20, Kind::UInt16, "point_source_id"),
                                  fieldAt(22, Kind::Double, "time")};
  constexpr double kAngleStep = 0.006;  // [degrees]
  fields[7].scale = kAngleStep;
  if (format == 7 || format == 8 || format == 10) fields.push_back(fieldAt(30, Kind::Colour, "rgb"));
  if (format == 8 || format == 10) fields.push_back(fieldAt(36, Kind::UInt16, "nir"));
  return fields;
}

/// The types of extra bytes from number 1 on.
constexpr Kind kExtraKinds[] = {Kind::UInt8, Kind::Int8,   Kind::UInt16, Kind::Int16, Kind::UInt32,
                                Kind::Int32, Kind::UInt64, Kind::Int64,  Kind::Float, Kind::Double};
constexpr std::size_t kExtraSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
constexpr std::size_t kExtraTypes = 10;
constexpr std::size_t kDescription = 192;  // bytes per description

/// One description of extra bytes: a value, an array of two or three, or bytes without meaning.
class ExtraBytes {
 public:
  explicit ExtraBytes(std::string_view bytes) : bytes_(bytes) {}

  bool isKnown() const { return type() <= 3 * kExtraTypes; }
  std::size_t elements() const { return type() == 0 ? 0 : 1 + (type() - 1) / kExtraTypes; }
  /// Returns the number of bytes in a record.
  std::size_t size() const { return type() == 0 ? options() : elements() * elementSize(); }

  LasField field(std::size_t element, std::size_t offset) const {
    constexpr unsigned kNoData = 1, kScale = 8, kOffset = 16;  // bits of the options
    LasField field;
    field.name = lasText(bytes_.substr(4, 32));
    if (elements() > 1) field.name += "[" + std::to_string(element) + "]";
    field.kind = kExtraKinds[(type() - 1) % kExtraTypes];
    field.offset = offset + element * elementSize();
    const char* const numbers = bytes_.data() + 8 * element;
    field.has_no_data = (options() & kNoData) != 0;
    field.no_data = lasNumber<std::uint64_t>(numbers + 40);
    if ((options() & kScale) != 0) field.scale = lasNumber<double>(numbers + 112);
    if ((options() & kOffset) != 0) field.shift_by = lasNumber<double>(numbers + 136);
    return field;
  }

 private:
  std::size_t type() const { return lasNumber<std::uint8_t>(bytes_.data() + 2); }
  unsigned options() const { return lasNumber<std::uint8_t>(bytes_.data() + 3); }
  std::size_t elementSize() const { return kExtraSizes[(type() - 1) % kExtraTypes]; }

  std::string_view bytes_;
};

void addExtraFields(const LasHeader& header, std::vector<LasField>& fields, std::string& warning) {
  const LasVlr* const record = header.find("LASF_Spec", 4);
  if (record == nullptr) return;
  std::vector<LasField> extra;
  std::size_t place = lasRecordLength(header.point_format);
  for (std::string_view rest = record->data; rest.size() >= kDescription; rest.remove_prefix(kDescription)) {
    const ExtraBytes bytes(rest.substr(0, kDescription));
    if (!bytes.isKnown() || bytes.size() > header.record_length - place) {
      warning = "the description of the extra bytes (byte " + std::to_string(record->offset) +
                (bytes.isKnown() ? ") describes more bytes than the " + std::to_string(header.record_length) +
                                       " bytes of a point have"
                                 : ") has an unknown type") +
                ": the extra bytes are ignored";
      return;
    }
    for (std::size_t element = 0; element < bytes.elements(); ++element) extra.push_back(bytes.field(element, place));
    place += bytes.size();
  }
  std::set<std::string> names = {"x", "y", "z"};
  for (const LasField& field : fields) names.insert(field.name);
  for (LasField& field : extra)
    if (!field.name.empty() && names.insert(field.name).second) fields.push_back(std::move(field));
}

/// Calls body(get), where get(place) returns the number at the place of a field.
template <typename T, typename Body>
void withType(const Body& body) {
  body([](const char* place) { return lasNumber<T>(place); });
}

/// Calls body(get) with the function that reads the field: bits and colours have their own.
template <typename Body>
void withReader(const LasField& field, const Body& body) {
  switch (field.kind) {
    case Kind::UInt8:
      return withType<std::uint8_t>(body);
    case Kind::Int8:
      return withType<std::int8_t>(body);
    case Kind::UInt16:
      return withType<std::uint16_t>(body);
    case Kind::Int16:
      return withType<std::int16_t>(body);
    case Kind::UInt32:
      return withType<std::uint32_t>(body);
    case Kind::Int32:
      return withType<std::int32_t>(body);
    case Kind::UInt64:
      return withType<std::uint64_t>(body);
    case Kind::Int64:
      return withType<std::int64_t>(body);
    case Kind::Float:
      return withType<float>(body);
    case Kind::Double:
      return withType<double>(body);
    case Kind::Bits:
      return body([&field](const char* place) {
        return static_cast<std::uint8_t>((lasNumber<std::uint8_t>(place) >> field.shift) & field.mask);
      });
    case Kind::Colour:
      return body([](const char* place) {
        std::uint64_t colour = 0;
        for (std::size_t channel = 0; channel < 3; ++channel)
          colour = colour << kColourBits | lasNumber<std::uint16_t>(place + 2 * channel);
        return colour;
      });
  }
}

/// Returns true if the number is the one that means "no value". That one is stored with 64 bits.
template <typename T>
bool isNoData(T number, std::uint64_t no_data) {
  using Wide = std::conditional_t<std::is_floating_point_v<T>, double,
                                  std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>>;
  Wide wide;
  std::memcpy(&wide, &no_data, sizeof(wide));
  return static_cast<Wide>(number) == wide;
}

}  // namespace

std::vector<LasField> lasFields(const LasHeader& header, std::string& warning) {
  std::vector<LasField> fields =
      header.point_format < 6 ? oldFields(header.point_format) : newFields(header.point_format);
  addExtraFields(header, fields, warning);
  return fields;
}

void decodeLasPoints(const LasHeader& header, const char* records, std::size_t count, PointBlock<3>& block) {
  block.size = count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double scale = header.scale[static_cast<Eigen::Index>(axis)];
    const double offset = header.offset[static_cast<Eigen::Index>(axis)];
    const char* const first = records + axis * sizeof(std::int32_t);
    for (std::size_t i = 0; i < count; ++i)
      block.coordinate[axis][i] = lasNumber<std::int32_t>(first + i * header.record_length) * scale + offset;
  }
}

void decodeLasField(const LasField& field, std::size_t record_length, const char* records, std::size_t count,
                    double* values) {
  withReader(field, [&](const auto& numberAt) {
    const char* place = records + field.offset;
    for (std::size_t i = 0; i < count; ++i, place += record_length) {
      const auto number = numberAt(place);
      values[i] = field.has_no_data && isNoData(number, field.no_data)
                      ? std::numeric_limits<double>::quiet_NaN()
                      : static_cast<double>(number) * field.scale + field.shift_by;
    }
  });
}

void finishLasColours(std::vector<double>& colours) {
  constexpr std::uint64_t kUpperBytes = 0xFF00FF00FF00;
  std::uint64_t used = 0;
  for (const double colour : colours) used |= static_cast<std::uint64_t>(colour);
  const int shift = (used & kUpperBytes) != 0 ? 8 : 0;
  for (double& value : colours) {
    const auto colour = static_cast<std::uint64_t>(value);
    const auto channel = [&](int number) { return ((colour >> (number * kColourBits)) & kChannel) >> shift; };
    value = static_cast<double>(channel(2) << 16 | channel(1) << 8 | channel(0));
  }
}

}  // namespace gaussmap::detail
