// SPDX-License-Identifier: BSD-3-Clause
#include "io/e57/e57_section.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "gaussmap/core/error.h"
#include "io/e57/e57_xml.h"

namespace gaussmap::detail {
namespace {

constexpr std::uint64_t kSectionHeaderBytes = 32;

std::string pointsOf(std::uint64_t points) {
  return std::to_string(points) + (points == 1 ? " point" : " points");
}

/// Returns the number of bytes of a field of all points, or false if that overflows.
bool fieldBytes(std::uint64_t points, const E57Field& field, std::uint64_t& bytes) {
  if (field.encoding == E57Encoding::String) {  // at least its length
    bytes = points;
    return true;
  }
  std::uint64_t bits = 0;
  if (__builtin_mul_overflow(points, std::uint64_t{field.bits()}, &bits)) return false;
  bytes = bits / 8 + (bits % 8 != 0);
  return true;
}

void requireSpace(const E57Pages& pages, const E57Scan& scan, std::size_t number, const E57Section& section) {
  std::uint64_t needed = 0;
  for (const E57Field& field : scan.fields) {
    std::uint64_t bytes = 0;
    if (fieldBytes(scan.points, field, bytes) && !__builtin_add_overflow(needed, bytes, &needed)) continue;
    throw FileError(pages.path(), e57Place(number) + "recordCount is " + std::to_string(scan.points) +
                                      ", more points than any file can hold: the XML section is damaged");
  }
  if (const std::uint64_t there = section.end - section.begin; needed > there)
    throw FileError(pages.path(), e57Place(number) + "recordCount is " + std::to_string(scan.points) +
                                      ", which takes at least " + std::to_string(needed) +
                                      " bytes, but the section of the points has " + std::to_string(there));
}

/// Returns the number of bytes that cannot be padding any more. Writers fill up the last word of a field of integers,
/// which has up to 8 bytes.
std::uint64_t paddingLimit(const E57Field& field) {
  return field.encoding == E57Encoding::Single ? sizeof(float) : 8u;
}

E57Section findSection(const E57Pages& pages, const E57Scan& scan, std::size_t number) {
  const auto fail = [&](const std::string& what) { throw FileError(pages.path(), e57Place(number) + what); };
  const std::string what = e57Place(number) + "the section of the points";
  const std::uint64_t start = pages.logicalOffset(scan.section, kSectionHeaderBytes, what);
  char header[kSectionHeaderBytes];
  pages.copy(start, sizeof(header), header);
  std::uint64_t length = 0, data = 0;
  std::memcpy(&length, header + 8, sizeof(length));
  std::memcpy(&data, header + 16, sizeof(data));
  const std::string place = "the section of the points at byte " + std::to_string(scan.section);
  if (header[0] != 1)
    fail(place + " starts with " + std::to_string(static_cast<unsigned char>(header[0])) +
         ", expected 1: the offset in the XML section is wrong, or the file is damaged");
  pages.logicalOffset(scan.section, length, what);
  const std::uint64_t packets = pages.logicalOffset(data, 0, e57Place(number) + "the first packet of the points");
  if (packets < start + kSectionHeaderBytes || packets > start + length)
    fail("the first packet of the points is at byte " + std::to_string(data) +
         ", outside its section, which starts at " + std::to_string(scan.section) + " and has " +
         std::to_string(length) + " bytes");
  return {packets, start + length};
}

/// Reads the packets of a section one after the other.
class E57PacketReader {
 public:
  E57PacketReader(const E57Pages& pages, const E57Scan& scan, std::size_t number, const E57Section& section,
                  const std::vector<std::size_t>& fields)
      : pages_(pages), scan_(scan), number_(number), section_(section), fields_(scan.fields.size()) {
    streams_.resize(fields.size());
    for (std::size_t i = 0; i < scan.fields.size(); ++i) fieldBytes(scan.points, scan.fields[i], fields_[i].needed);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      constexpr std::size_t kPadding = 16;
      const auto bytes = static_cast<std::size_t>(fields_[fields[i]].needed);
      streams_[i].bytes.reset(new char[bytes + kPadding]);
      std::memset(streams_[i].bytes.get() + bytes, 0, kPadding);
      fields_[fields[i]].to = streams_[i].bytes.get();
    }
  }

  std::vector<E57Stream> read() {
    std::uint64_t position = section_.begin;
    while (position < section_.end) position = readPacket(position);
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (scan_.fields[i].encoding != E57Encoding::String && fields_[i].found < fields_[i].needed)
        fail("recordCount is " + std::to_string(scan_.points) + ", but the packets hold only " +
             pointsOf(fields_[i].found * 8 / std::max(scan_.fields[i].bits(), 1u)) + " of the field " +
             scan_.fields[i].name + ": the file is damaged, or its writer did not finish");
    return std::move(streams_);
  }

 private:
  struct Field {
    std::uint64_t needed = 0, found = 0;  // bytes
    char* to = nullptr;                   // nullptr: not wanted
  };
  enum PacketType : unsigned char { kIndex = 0, kData = 1, kEmpty = 2 };

  [[noreturn]] void fail(const std::string& what) const { throw FileError(pages_.path(), e57Place(number_) + what); }
  [[noreturn]] void failAt(std::uint64_t packet, const std::string& what) const {
    fail("the packet at byte " + std::to_string(pages_.physicalOffset(packet)) + " " + what);
  }

  /// Returns the offset of the next packet.
  std::uint64_t readPacket(std::uint64_t position) {
    constexpr std::uint64_t kShortest = 4;
    const std::uint64_t left = section_.end - position;
    if (left < kShortest) {
      if (isComplete()) return section_.end;  // padding
      failAt(position, "has only " + std::to_string(left) + " bytes up to the end of its section");
    }
    unsigned char start[kShortest];
    pages_.copy(position, sizeof(start), reinterpret_cast<char*>(start));
    const std::uint64_t length = (std::uint64_t{start[3]} << 8 | start[2]) + 1;
    const bool has_good_length = length % 4 == 0 && length <= left;
    if (start[0] == kData && has_good_length) {
      readData(position, length);
    } else if (start[0] > kEmpty || !has_good_length) {
      // Some writers fill the end of a section with other bytes.
      if (start[0] != kData && isComplete()) return section_.end;
      if (start[0] > kEmpty)
        failAt(position, "has the type " + std::to_string(start[0]) + ", expected 0 (index), 1 (data) or 2 (empty)");
      failAt(position, "has the length " + std::to_string(length) + ", expected a multiple of 4 up to " +
                           std::to_string(left) + ", the rest of its section");
    }
    return position + length;
  }

  bool isComplete() const {
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (fields_[i].found < fields_[i].needed) return false;
    return true;
  }

  void readData(std::uint64_t packet, std::uint64_t length) {
    constexpr std::uint64_t kHeader = 6;
    if (length < kHeader) failAt(packet, "has " + std::to_string(length) + " bytes, too few for a data packet");
    std::uint16_t count = 0;
    pages_.copy(packet + 4, sizeof(count), reinterpret_cast<char*>(&count));
    if (count != fields_.size())
      failAt(packet, "holds " + std::to_string(count) + " fields, but the XML section describes " +
                         std::to_string(fields_.size()));
    std::uint64_t place = kHeader + std::uint64_t{2} * count;
    if (place > length) failAt(packet, "is too short for the lengths of its " + std::to_string(count) + " fields");
    lengths_.resize(count);
    pages_.copy(packet + kHeader, std::size_t{2} * count, reinterpret_cast<char*>(lengths_.data()));
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (lengths_[i] > length - place)
        failAt(packet, "has " + std::to_string(length) + " bytes, but its fields have more");
      append(i, packet + place, lengths_[i], packet);
      place += lengths_[i];
    }
  }

  void append(std::size_t index, std::uint64_t from, std::uint64_t bytes, std::uint64_t packet) {
    Field& field = fields_[index];
    const std::uint64_t missing = field.found < field.needed ? field.needed - field.found : 0;
    const std::uint64_t used = bytes < missing ? bytes : missing;
    if (field.to != nullptr && used > 0) pages_.copy(from, static_cast<std::size_t>(used), field.to + field.found);
    field.found += bytes;
    const E57Field& described = scan_.fields[index];
    if (described.encoding != E57Encoding::String && field.found >= field.needed + paddingLimit(described))
      failAt(packet, "holds more of the field " + described.name +
                         " than recordCount = " + std::to_string(scan_.points) +
                         " allows: the XML section and the packets contradict each other");
  }

  const E57Pages& pages_;
  const E57Scan& scan_;
  std::size_t number_;
  E57Section section_;
  std::vector<Field> fields_;
  std::vector<E57Stream> streams_;
  std::vector<std::uint16_t> lengths_;
};

}  // namespace

std::vector<E57Section> findE57Sections(const E57Pages& pages, const E57Description& description) {
  std::vector<E57Section> sections;
  std::uint64_t bytes = 0, constant_points = 0;
  for (std::size_t i = 0; i < description.scans.size(); ++i) {
    const E57Scan& scan = description.scans[i];
    sections.emplace_back();
    if (scan.points == 0) continue;  // writers do not agree on the section of a scan without points
    const E57Section section = findSection(pages, scan, i);
    requireSpace(pages, scan, i, section);
    sections.back() = section;
    bytes += section.end - section.begin;
    if (bytes > pages.logicalBytes())
      throw FileError(pages.path(), "the sections of the scans 0 to " + std::to_string(i) +
                                        " have more bytes than the file: the scans share sections");
    bool is_constant = true;
    for (const E57Field& field : scan.fields)
      is_constant = is_constant && field.bits() == 0 && field.encoding != E57Encoding::String;
    if (!is_constant) continue;
    if (scan.points > pages.logicalBytes() - constant_points)
      throw FileError(pages.path(), e57Place(i) + "recordCount is " + std::to_string(scan.points) +
                                        ", but all fields are constant, so the file holds no data of these points");
    constant_points += scan.points;
  }
  return sections;
}

std::vector<E57Stream> loadE57Streams(const E57Pages& pages, const E57Scan& scan, std::size_t scan_number,
                                      const E57Section& section, const std::vector<std::size_t>& fields) {
  if (scan.points == 0) return std::vector<E57Stream>(fields.size());
  return E57PacketReader(pages, scan, scan_number, section, fields).read();
}

}  // namespace gaussmap::detail
