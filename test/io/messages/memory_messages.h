// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/core/pose.h"
#include "io/formats/message_file.h"

// A recording in memory, and a writer of messages byte by byte.
namespace gaussmap::test {

using detail::MessageEncoding;

/// Writes the values of a message one after another, in ROS 1 serialization or little-endian CDR.
class WireBytes {
 public:
  explicit WireBytes(MessageEncoding encoding = MessageEncoding::Ros1) : aligned_(encoding == MessageEncoding::Cdr) {
    if (aligned_) bytes_ = std::string("\0\1\0\0", 4);
  }
  template <typename T>
  WireBytes& put(T value) {
    while (aligned_ && bytes_.size() % sizeof(T) != 4 % sizeof(T)) bytes_ += '\0';
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  WireBytes& text(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size() + (aligned_ ? 1 : 0)));
    bytes_.append(value.c_str(), value.size() + (aligned_ ? 1 : 0));
    return *this;
  }
  WireBytes& data(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  WireBytes& header(double time, const std::string& frame) {
    if (!aligned_) put(std::uint32_t{0});
    const auto count = static_cast<std::int64_t>(time * 1000.0 + 0.5);  // times of whole milliseconds
    put(static_cast<std::uint32_t>(count / 1000)).put(static_cast<std::uint32_t>(count % 1000 * 1000000));
    return text(frame);
  }
  WireBytes& pose(const Pose& pose) {
    for (int i = 0; i < 3; ++i) put(pose.translation(i));
    return put(pose.rotation.x()).put(pose.rotation.y()).put(pose.rotation.z()).put(pose.rotation.w());
  }
  WireBytes& zeros(std::size_t doubles) {
    for (std::size_t i = 0; i < doubles; ++i) put(0.0);
    return *this;
  }
  std::string str() const { return bytes_; }

 private:
  bool aligned_;
  std::string bytes_;
};

/// The layout of a cloud of x y z floats. Change it to damage the message.
struct CloudBytes {
  std::string frame = "lidar";
  std::uint32_t height = 1, width = 2, point_step = 12, row_step = 24;
  std::vector<std::pair<std::string, std::uint32_t>> fields = {{"x", 0}, {"y", 4}, {"z", 8}};  // name, offset
  std::uint8_t datatype = 7;
  std::uint32_t count = 1;
  std::string data = std::string(24, '\0');

  std::string at(double time, MessageEncoding encoding = MessageEncoding::Ros1) const {
    WireBytes bytes(encoding);
    bytes.header(time, frame).put(height).put(width).put(static_cast<std::uint32_t>(fields.size()));
    for (const auto& [name, offset] : fields) bytes.text(name).put(offset).put(datatype).put(count);
    bytes.put(std::uint8_t{0}).put(point_step).put(row_step).data(data).put(std::uint8_t{1});
    return bytes.str();
  }
};

inline std::string transformBytes(double time, const std::string& parent, const std::string& child, const Pose& pose) {
  return WireBytes().put(std::uint32_t{1}).header(time, parent).text(child).pose(pose).str();
}
inline std::string odometryBytes(double time, const std::string& parent, const std::string& child, const Pose& pose) {
  return WireBytes().header(time, parent).text(child).pose(pose).zeros(36 + 6 + 36).str();
}
inline std::string poseBytes(double time, const std::string& parent, const Pose& pose) {
  return WireBytes().header(time, parent).pose(pose).str();
}

inline Pose poseAt(double x, double yaw = 0.0) {
  Pose pose;
  pose.translation = {x, 0.0, 0.0};
  pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return pose;
}

/// A recording in memory. Messages must be added in the order of their times.
class MemoryMessages : public detail::MessageFile {
 public:
  std::size_t addTopic(const std::string& name, const std::string& type,
                       MessageEncoding encoding = MessageEncoding::Ros1) {
    topics_.push_back({name, type, encoding, 0});
    return topics_.size() - 1;
  }
  void add(std::size_t topic, double log_time, std::string bytes) {
    ++topics_.at(topic).messages;
    places_.push_back(
        {topic, std::chrono::milliseconds(static_cast<std::int64_t>(log_time * 1000.0 + 0.5)), bytes_.size()});
    bytes_.push_back(std::move(bytes));
  }

  std::string kind() const override { return "memory"; }
  const std::vector<detail::MessageTopic>& topics() const override { return topics_; }
  const std::vector<detail::MessagePlace>& messages() const override { return places_; }
  std::vector<char> read(const detail::MessagePlace& message) const override {
    const std::string& bytes = bytes_.at(message.place);
    return {bytes.begin(), bytes.end()};
  }

 private:
  std::vector<detail::MessageTopic> topics_;
  std::vector<detail::MessagePlace> places_;
  std::vector<std::string> bytes_;
};

}  // namespace gaussmap::test
