// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/message_scans.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include "io/messages/cloud_layout.h"

namespace gaussmap::detail {
namespace {

constexpr double kNoPoint = std::numeric_limits<double>::quiet_NaN();

/// Base of the readers: owns the bytes of the message.
class MessageReader : public ScanReader {
 public:
  MessageReader(std::vector<char> bytes, std::size_t points) : bytes_(std::move(bytes)), points_(points) {}
  std::size_t size() const override { return points_; }

 protected:
  /// Returns the number of points in the block from `first` on, and stores it in the block.
  std::size_t start(std::size_t first, PointBlock<3>& block) const {
    return block.size = first < points_ ? std::min(PointBlock<3>::kCapacity, points_ - first) : 0;
  }

 private:
  std::vector<char> bytes_;
  std::size_t points_;
};

class CloudReader : public MessageReader {
 public:
  CloudReader(std::vector<char> bytes, CloudLayout layout, const char* data)
      : MessageReader(std::move(bytes), layout.points), layout_(std::move(layout)), data_(data) {}

  int columns() const override { return layout_.columns; }
  void read(std::size_t first, PointBlock<3>& block) const override {
    const std::size_t count = start(first, block);
    for (std::size_t axis = 0; axis < 3; ++axis) widen(layout_.axes[axis], first, count, block.coordinate[axis]);
  }
  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const CloudColumn& value : layout_.values) names.push_back(value.name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const CloudColumn& value : layout_.values) {
      if (value.name != name) continue;
      std::vector<double> numbers(size());
      widen(value, 0, size(), numbers.data());
      return numbers;
    }
    return ScanReader::values(name);
  }

 private:
  void widen(const CloudColumn& column, std::size_t first, std::size_t count, double* values) const {
    if (count == 0) return;
    const std::size_t step = layout_.point_step;
    if (layout_.row_step == layout_.width * step)
      return loadNumbers(column.type, layout_.swapped, data_ + first * step + column.offset, step, count, values);
    while (count > 0) {
      const std::size_t row = first / layout_.width, place = first % layout_.width;
      const std::size_t part = std::min(count, layout_.width - place);
      loadNumbers(column.type, layout_.swapped, data_ + row * layout_.row_step + place * step + column.offset, step,
                  part, values);
      first += part;
      values += part;
      count -= part;
    }
  }

  CloudLayout layout_;
  const char* data_;  // in the bytes of the base
};

class LaserReader : public MessageReader {
 public:
  LaserReader(std::vector<char> bytes, LaserMessage laser)
      : MessageReader(std::move(bytes), laser.ranges.size()), laser_(std::move(laser)) {
    if (laser_.range_max > laser_.range_min) {
      least_ = laser_.range_min;
      most_ = laser_.range_max;
    }
  }

  void read(std::size_t first, PointBlock<3>& block) const override {
    const std::size_t count = start(first, block);
    for (std::size_t i = 0; i < count; ++i) {
      const float range = laser_.ranges[first + i];
      const double angle = static_cast<double>(laser_.angle_min) +
                           static_cast<double>(first + i) * static_cast<double>(laser_.angle_increment);
      const bool is_point = std::isfinite(range) && range >= least_ && range <= most_ && std::isfinite(angle);
      block.coordinate[0][i] = is_point ? static_cast<double>(range) * std::cos(angle) : kNoPoint;
      block.coordinate[1][i] = is_point ? static_cast<double>(range) * std::sin(angle) : kNoPoint;
      block.coordinate[2][i] = is_point ? 0.0 : kNoPoint;
    }
  }
  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    if (hasIntensities()) names.emplace_back("intensity");
    if (hasTimes()) names.emplace_back("time");
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    std::vector<double> numbers(size());
    if (name == "intensity" && hasIntensities()) {
      for (std::size_t i = 0; i < size(); ++i) numbers[i] = static_cast<double>(laser_.intensities[i]);
    } else if (name == "time" && hasTimes()) {
      for (std::size_t i = 0; i < size(); ++i)
        numbers[i] = static_cast<double>(i) * static_cast<double>(laser_.time_increment);
    } else {
      return ScanReader::values(name);
    }
    return numbers;
  }

 private:
  bool hasIntensities() const { return size() > 0 && laser_.intensities.size() == size(); }
  bool hasTimes() const { return std::isfinite(laser_.time_increment) && laser_.time_increment != 0.0f; }

  LaserMessage laser_;
  float least_ = 0.0f, most_ = std::numeric_limits<float>::infinity();
};

class OldCloudReader : public MessageReader {
 public:
  OldCloudReader(std::vector<char> bytes, OldCloudMessage cloud)
      : MessageReader(std::move(bytes), cloud.coordinates.size() / 3), cloud_(std::move(cloud)) {}

  void read(std::size_t first, PointBlock<3>& block) const override {
    const std::size_t count = start(first, block);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        block.coordinate[axis][i] = static_cast<double>(cloud_.coordinates[3 * (first + i) + axis]);
  }
  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const auto& [name, values] : cloud_.channels) names.emplace_back(name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const auto& [channel, values] : cloud_.channels) {
      if (channel != name) continue;
      std::vector<double> numbers(size());
      for (std::size_t i = 0; i < size(); ++i) numbers[i] = static_cast<double>(values[i]);
      return numbers;
    }
    return ScanReader::values(name);
  }

 private:
  OldCloudMessage cloud_;
};

/// Throws FileError unless each channel has one value per point.
void checkChannels(const OldCloudMessage& cloud, const MessageOrigin& origin) {
  const std::size_t points = cloud.coordinates.size() / 3;
  for (const auto& [name, values] : cloud.channels)
    if (values.size() != points)
      origin.fail("channel '" + shown(name) + "' has " + std::to_string(values.size()) + " values for " +
                  std::to_string(points) + " points");
}

/// Throws FileError if the angles are not finite.
void checkAngles(const LaserMessage& laser, const MessageOrigin& origin) {
  if (!std::isfinite(laser.angle_min) || !std::isfinite(laser.angle_increment))
    origin.fail("angle_min or angle_increment is not finite");
}

/// Returns the size of a cloud, whose data are not needed.
MessageScanSize sizeOfCloud(CloudMessage cloud, const MessageOrigin& origin) {
  const CloudLayout layout = layoutOf(cloud, origin);
  // Rows can have padding, but a single row needs none.
  const bool has_unused = cloud.height == 1 && layout.row_step >= (layout.width + 1) * layout.point_step;
  return {std::move(cloud.header), layout.points, has_unused, true};
}

}  // namespace

bool isCloudType(const std::string& type) {
  return type == "sensor_msgs/PointCloud2";
}

bool isScanType(const std::string& type) {
  return isCloudType(type) || type == "sensor_msgs/LaserScan" || type == "sensor_msgs/PointCloud";
}

MessageScanSize scanSize(const std::string& type, std::string_view message, MessageEncoding encoding,
                         const MessageOrigin& origin) {
  if (type == "sensor_msgs/LaserScan") {
    LaserMessage laser = decodeLaser(message, encoding, origin);
    checkAngles(laser, origin);
    return {std::move(laser.header), laser.ranges.size(), false, laser.range_max > laser.range_min};
  }
  if (type == "sensor_msgs/PointCloud") {
    OldCloudMessage cloud = decodeOldCloud(message, encoding, origin);
    checkChannels(cloud, origin);
    return {std::move(cloud.header), cloud.coordinates.size() / 3, false, true};
  }
  return sizeOfCloud(decodeCloud(message, encoding, origin), origin);
}

std::optional<MessageScanSize> scanSizeOfStart(const MessageStart& start, MessageEncoding encoding,
                                               const MessageOrigin& origin) {
  try {
    return sizeOfCloud(decodeCloudStart({start.bytes.data(), start.bytes.size()}, start.size, encoding, origin),
                       origin);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

std::unique_ptr<ScanReader> readScan(const std::string& type, std::vector<char> message, MessageEncoding encoding,
                                     const MessageOrigin& origin) {
  const std::string_view bytes(message.data(), message.size());
  if (type == "sensor_msgs/LaserScan") {
    LaserMessage laser = decodeLaser(bytes, encoding, origin);
    checkAngles(laser, origin);
    return std::make_unique<LaserReader>(std::move(message), std::move(laser));
  }
  if (type == "sensor_msgs/PointCloud") {
    OldCloudMessage cloud = decodeOldCloud(bytes, encoding, origin);
    checkChannels(cloud, origin);
    return std::make_unique<OldCloudReader>(std::move(message), std::move(cloud));
  }
  const CloudMessage cloud = decodeCloud(bytes, encoding, origin);
  return std::make_unique<CloudReader>(std::move(message), layoutOf(cloud, origin), cloud.data.data());
}

}  // namespace gaussmap::detail
