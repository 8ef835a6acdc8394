// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "io/pcd/pcd_bytes.h"

// Writes LAS files for tests, byte by byte, without the library.
namespace gaussmap::test {

/// A LAS file whose header can lie. The defaults are two points of format 0.
struct LasBytes {
  int minor = 2;
  int format = 0;
  std::size_t record_length = 20;
  std::uint16_t encoding = 0;
  std::string vlrs;
  std::uint32_t vlr_count = 0;
  std::string evlrs;
  std::uint32_t evlr_count = 0;
  std::array<double, 3> scale = {0.5, 0.5, 0.25};
  std::array<double, 3> offset = {10.0, 20.0, 30.0};
  std::array<double, 6> box = {};  ///< max x, min x, max y ...; all zero: not set
  std::vector<std::array<std::int32_t, 3>> points = {{1, 2, 3}, {-4, 5, -6}};
  std::uint64_t count = 2;
  std::uint32_t legacy_count = 2;

  std::size_t headerSize() const { return minor <= 2 ? 227 : minor == 3 ? 235 : 375; }
  std::size_t dataOffset() const { return headerSize() + vlrs.size(); }

  std::string str() const {
    std::string bytes(headerSize(), '\0');
    const auto put = [&bytes](std::size_t place, auto value) { std::memcpy(&bytes[place], &value, sizeof(value)); };
    std::memcpy(bytes.data(), "LASF", 4);
    put(6, encoding);
    put(24, std::uint8_t{1});
    put(25, static_cast<std::uint8_t>(minor));
    put(94, static_cast<std::uint16_t>(headerSize()));
    put(96, static_cast<std::uint32_t>(dataOffset()));
    put(100, vlr_count);
    put(104, static_cast<std::uint8_t>(format));
    put(105, static_cast<std::uint16_t>(record_length));
    put(107, minor < 4 ? static_cast<std::uint32_t>(count) : legacy_count);
    for (std::size_t i = 0; i < 3; ++i) {
      put(131 + 8 * i, scale[i]);
      put(155 + 8 * i, offset[i]);
    }
    for (std::size_t i = 0; i < 6; ++i) put(179 + 8 * i, box[i]);
    if (minor >= 4) {
      put(235, static_cast<std::uint64_t>(evlr_count > 0 ? dataOffset() + points.size() * record_length : 0));
      put(243, evlr_count);
      put(247, count);
    }
    bytes += vlrs;
    for (const std::array<std::int32_t, 3>& point : points) {
      std::string record(record_length, '\0');
      std::memcpy(record.data(), point.data(), 12);
      bytes += record;
    }
    return bytes + evlrs;
  }
};

/// Returns a text in a field of fixed length.
inline std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

/// Returns a variable length record.
inline std::string vlr(const std::string& user, std::uint16_t id, const std::string& data) {
  return bytesOf(std::uint16_t{0}) + padded(user, 16) + bytesOf(id) + bytesOf(static_cast<std::uint16_t>(data.size())) +
         padded("", 32) + data;
}

/// Returns an extended variable length record.
inline std::string evlr(const std::string& user, std::uint16_t id, const std::string& data) {
  return bytesOf(std::uint16_t{0}) + padded(user, 16) + bytesOf(id) + bytesOf(static_cast<std::uint64_t>(data.size())) +
         padded("", 32) + data;
}

/// Returns the data of a GeoTIFF record: each key has a number, the place of its value, a count and a value.
inline std::string geoKeys(const std::vector<std::array<std::uint16_t, 4>>& keys) {
  std::string data = bytesOf(std::uint16_t{1}) + bytesOf(std::uint16_t{1}) + bytesOf(std::uint16_t{0}) +
                     bytesOf(static_cast<std::uint16_t>(keys.size()));
  for (const auto& key : keys)
    for (const std::uint16_t number : key) data += bytesOf(number);
  return data;
}

}  // namespace gaussmap::test
