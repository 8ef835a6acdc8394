// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "gaussmap/core/scans.h"

// Writes E57 files for tests without the library, from the description of the format.
namespace gaussmap::test {

template <typename T>
std::string e57Bytes(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

/// Returns the CRC-32C, bit by bit.
inline std::uint32_t slowCrc32c(const std::string& bytes) {
  std::uint32_t crc = ~0u;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0x82F63B78u : crc >> 1;
  }
  return ~crc;
}

constexpr std::size_t kE57Header = 48;

/// Adds the checksums to the bytes of a file. The last page is filled up with zeros.
inline std::string e57Pages(std::string logical, std::size_t page = 1024) {
  const std::size_t data = page - 4;
  logical.resize((logical.size() + data - 1) / data * data, '\0');
  std::string file;
  for (std::size_t first = 0; first < logical.size(); first += data) {
    const std::string piece = logical.substr(first, data);
    const std::uint32_t crc = slowCrc32c(piece);
    file += piece;
    for (int shift = 24; shift >= 0; shift -= 8) file += static_cast<char>(crc >> shift);
  }
  return file;
}

inline std::uint64_t e57Physical(std::uint64_t logical, std::uint64_t page = 1024) {
  return logical / (page - 4) * page + logical % (page - 4);
}

/// Returns a file: the header, `body`, which starts at byte 48, and `xml`.
inline std::string e57File(const std::string& body, const std::string& xml, std::size_t page = 1024) {
  const std::uint64_t logical = kE57Header + body.size() + xml.size();
  const std::uint64_t pages = (logical + page - 5) / (page - 4);
  const std::string header = "ASTM-E57" + e57Bytes(1u) + e57Bytes(0u) + e57Bytes(pages * page) +
                             e57Bytes(e57Physical(kE57Header + body.size(), page)) +
                             e57Bytes(std::uint64_t{xml.size()}) + e57Bytes(std::uint64_t{page});
  return e57Pages(header + body + xml, page);
}

/// Packs the lowest `bits` bits of each number, the first number into the lowest bits.
inline std::string packBits(const std::vector<std::uint64_t>& numbers, unsigned bits) {
  std::string bytes((numbers.size() * bits + 7) / 8, '\0');
  std::size_t place = 0;
  for (const std::uint64_t number : numbers)
    for (unsigned bit = 0; bit < bits; ++bit, ++place)
      if ((number >> bit & 1u) != 0)
        bytes[place / 8] = static_cast<char>(static_cast<unsigned char>(bytes[place / 8]) | 1u << place % 8);
  return bytes;
}

/// Returns a data packet with one piece per field.
inline std::string dataPacket(const std::vector<std::string>& fields) {
  std::string rest = e57Bytes(static_cast<std::uint16_t>(fields.size()));
  for (const std::string& field : fields) rest += e57Bytes(static_cast<std::uint16_t>(field.size()));
  for (const std::string& field : fields) rest += field;
  rest.resize((rest.size() + 3) / 4 * 4, '\0');
  return std::string("\1\0", 2) + e57Bytes(static_cast<std::uint16_t>(rest.size() + 3)) + rest;
}

/// Returns the data packets of whole fields, with pieces of at most `piece` bytes.
inline std::string dataPackets(std::vector<std::string> fields, std::size_t piece) {
  std::string packets;
  const auto isLeft = [&] {
    return std::any_of(fields.begin(), fields.end(), [](const std::string& field) { return !field.empty(); });
  };
  while (isLeft()) {
    std::vector<std::string> pieces;
    for (std::string& field : fields) {
      pieces.push_back(field.substr(0, piece));
      field.erase(0, piece);
    }
    packets += dataPacket(pieces);
  }
  return packets;
}

/// Returns a section of points that starts at this logical offset.
inline std::string e57Section(const std::string& packets, std::uint64_t logical = kE57Header,
                              std::uint64_t page = 1024) {
  return std::string("\1\0\0\0\0\0\0\0", 8) + e57Bytes(std::uint64_t{32 + packets.size()}) +
         e57Bytes(e57Physical(logical + 32, page)) + e57Bytes(std::uint64_t{0}) + packets;
}

/// Returns the element of a scan. `fields` are the elements of the prototype.
inline std::string e57ScanXml(std::uint64_t points, const std::string& fields, const std::string& more = "",
                              std::uint64_t offset = kE57Header) {
  return "<vectorChild type=\"Structure\">" + more + "<points type=\"CompressedVector\" fileOffset=\"" +
         std::to_string(offset) + "\" recordCount=\"" + std::to_string(points) + "\"><prototype type=\"Structure\">" +
         fields + "</prototype><codecs type=\"Vector\"/></points></vectorChild>";
}

inline std::string e57Xml(const std::string& scans, const std::string& more = "") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
         "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\">" +
         more + "<data3D type=\"Vector\" allowHeterogeneousChildren=\"1\">" + scans + "</data3D></e57Root>\n";
}

inline std::string e57Integer(const std::string& name, std::int64_t minimum, std::int64_t maximum) {
  return "<" + name + " type=\"Integer\" minimum=\"" + std::to_string(minimum) + "\" maximum=\"" +
         std::to_string(maximum) + "\"/>";
}

const std::string kSingleXyz =
    "<cartesianX type=\"Float\" precision=\"single\"/><cartesianY type=\"Float\" precision=\"single\"/>"
    "<cartesianZ type=\"Float\" precision=\"single\"/>";

/// Returns a file with single x, y and z: point i is (i, -i, i + 0.5). The XML section claims `claimed` points.
inline std::string singleFile(std::size_t points, std::uint64_t claimed, std::size_t page = 1024) {
  std::vector<std::string> fields(3);
  for (std::size_t i = 0; i < points; ++i) {
    const auto value = static_cast<float>(i);
    fields[0] += e57Bytes(value);
    fields[1] += e57Bytes(-value);
    fields[2] += e57Bytes(value + 0.5f);
  }
  return e57File(e57Section(dataPackets(fields, 1000), kE57Header, page), e57Xml(e57ScanXml(claimed, kSingleXyz)),
                 page);
}

using E57Axes = std::vector<std::vector<double>>;

/// Returns all points of a scan, axis by axis.
inline E57Axes readAll(const ScanReader& reader) {
  E57Axes axes(3);
  PointBlock<3> block;
  for (std::size_t first = 0; reader.read(first, block), block.size > 0; first += block.size)
    for (std::size_t axis = 0; axis < 3; ++axis)
      axes[axis].insert(axes[axis].end(), block.coordinate[axis], block.coordinate[axis] + block.size);
  return axes;
}

}  // namespace gaussmap::test
