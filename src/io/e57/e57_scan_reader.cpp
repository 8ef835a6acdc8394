// SPDX-License-Identifier: BSD-3-Clause
#include "io/e57/e57_scan_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "gaussmap/core/error.h"
#include "io/e57/e57_numbers.h"
#include "io/e57/e57_xml.h"

namespace gaussmap::detail {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBlock = PointBlock<3>::kCapacity;

/// Replaces range [m], azimuth and elevation [rad] by x, y and z [m].
void makeCartesian(PointBlock<3>& block) {
  for (std::size_t i = 0; i < block.size; ++i) {
    const double range = block.coordinate[0][i], azimuth = block.coordinate[1][i], elevation = block.coordinate[2][i];
    const double horizontal = range * std::cos(elevation);
    block.coordinate[0][i] = horizontal * std::cos(azimuth);
    block.coordinate[1][i] = horizontal * std::sin(azimuth);
    block.coordinate[2][i] = range * std::sin(elevation);
  }
}

/// Returns a colour as a whole number from 0 to 255.
std::uint32_t byteOf(double colour, const E57Limits& limits) {
  const double scaled = (colour - limits.minimum) / (limits.maximum - limits.minimum) * 255.0;
  if (!(scaled > 0.0)) return 0;
  return static_cast<std::uint32_t>(std::lround(std::min(scaled, 255.0)));
}

}  // namespace

void E57ScanReader::read(std::size_t first, PointBlock<3>& block) const {
  block.size = 0;
  if (first >= size()) return;
  load();
  const E57Coordinates& coordinates = contents_->coordinates[number_];
  const std::size_t count = std::min(kBlock, size() - first);
  for (std::size_t axis = 0; axis < 3; ++axis)
    decode(coordinates.fields[axis], streams_[axis], first, count, block.coordinate[axis]);
  block.size = count;
  if (coordinates.is_spherical) makeCartesian(block);
  if (!coordinates.invalid) return;
  std::array<double, kBlock> invalid;
  decode(*coordinates.invalid, streams_[3], first, count, invalid.data());
  for (std::size_t i = 0; i < count; ++i)
    if (invalid[i] != 0.0)
      for (auto& axis : block.coordinate) axis[i] = kNoNumber;
}

void E57ScanReader::load() const {
  if (is_loaded_.load(std::memory_order_acquire)) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (is_loaded_.load(std::memory_order_relaxed)) return;
  const E57Coordinates& coordinates = contents_->coordinates[number_];
  std::vector<std::size_t> fields(coordinates.fields.begin(), coordinates.fields.end());
  if (coordinates.invalid) fields.push_back(*coordinates.invalid);
  streams_ = streamsOf(fields);
  is_loaded_.store(true, std::memory_order_release);
}

std::vector<E57Stream> E57ScanReader::streamsOf(const std::vector<std::size_t>& fields) const {
  std::vector<E57Stream> streams =
      loadE57Streams(contents_->pages, scan(), number_, contents_->sections[number_], fields);
  requireWhole();
  return streams;
}

void E57ScanReader::decode(std::size_t field, const E57Stream& stream, std::size_t first, std::size_t count,
                           double* values) const {
  const E57Field& described = scan().fields[field];
  const std::size_t good = decodeE57(described, stream.bytes.get(), first, count, values);
  if (good < count)
    throw FileError(contents_->pages.path(), e57Place(number_) + "point " + std::to_string(first + good) +
                                                 ": the field " + described.name + " is greater than its maximum " +
                                                 std::to_string(described.maximum) + " in the XML section");
}

std::vector<std::string> E57ScanReader::valueNames() const {
  std::vector<std::string> names;
  for (const E57Value& value : valuesOf(scan(), contents_->coordinates[number_])) names.push_back(value.name);
  return names;
}

std::vector<double> E57ScanReader::values(const std::string& name) const {
  for (const E57Value& value : valuesOf(scan(), contents_->coordinates[number_]))
    if (value.name == name) return decodeValue(value);
  return ScanReader::values(name);
}

std::vector<double> E57ScanReader::decodeValue(const E57Value& value) const {
  std::vector<std::size_t> fields = value.fields;
  if (value.invalid) fields.push_back(*value.invalid);
  const std::vector<E57Stream> streams = streamsOf(fields);
  std::vector<double> result(size());
  std::array<std::array<double, kBlock>, 3> colours;
  std::array<double, kBlock> invalid;
  for (std::size_t first = 0; first < size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, size() - first);
    if (value.fields.size() == 1) {
      decode(value.fields[0], streams[0], first, count, result.data() + first);
    } else {
      for (std::size_t i = 0; i < 3; ++i) decode(value.fields[i], streams[i], first, count, colours[i].data());
      for (std::size_t i = 0; i < count; ++i)
        result[first + i] = byteOf(colours[0][i], value.limits[0]) << 16 | byteOf(colours[1][i], value.limits[1]) << 8 |
                            byteOf(colours[2][i], value.limits[2]);
    }
    if (!value.invalid) continue;
    decode(*value.invalid, streams.back(), first, count, invalid.data());
    for (std::size_t i = 0; i < count; ++i)
      if (invalid[i] != 0.0) result[first + i] = kNoNumber;
  }
  return result;
}

}  // namespace gaussmap::detail
