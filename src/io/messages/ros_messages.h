// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gaussmap/core/pose.h"
#include "io/messages/wire_reader.h"

// The messages of ROS 1 and ROS 2 that gaussmap reads. Views point into the bytes of the message. The functions throw
// FileError if a message ends early, or if its lengths contradict its size.
namespace gaussmap::detail {

/// std_msgs/Header.
struct MessageHeader {
  std::chrono::nanoseconds stamp{0};
  std::string frame;
};

/// sensor_msgs/PointField.
struct CloudField {
  std::string_view name;
  std::uint32_t offset = 0;   ///< from the start of a point [bytes]
  std::uint8_t datatype = 0;  ///< 1 to 8: int8, uint8, int16, uint16, int32, uint32, float32, float64
  std::uint32_t count = 0;
};

/// sensor_msgs/PointCloud2.
struct CloudMessage {
  MessageHeader header;
  std::uint32_t height = 0, width = 0;
  std::vector<CloudField> fields;
  bool big_endian = false;  ///< the data, not the message
  std::uint32_t point_step = 0, row_step = 0;
  std::size_t data_size = 0;
  std::string_view data;  ///< empty if only the start of the message was decoded
};

/// sensor_msgs/LaserScan.
struct LaserMessage {
  MessageHeader header;
  float angle_min = 0, angle_increment = 0, time_increment = 0, range_min = 0, range_max = 0;
  FloatsView ranges, intensities;
};

/// sensor_msgs/PointCloud, the cloud before PointCloud2.
struct OldCloudMessage {
  MessageHeader header;
  FloatsView coordinates;  ///< x y z of each point
  std::vector<std::pair<std::string_view, FloatsView>> channels;
};

/// geometry_msgs/TransformStamped; also a pose with a time: the pose of `child` in the frame `parent`.
struct StampedTransform {
  std::chrono::nanoseconds stamp{0};
  std::string parent;
  std::string child;  ///< empty if the message does not say whose pose it is
  Pose pose;          ///< as written, not checked
};

/// Reads the first value of most messages.
MessageHeader decodeHeader(WireReader& reader);

CloudMessage decodeCloud(std::string_view message, MessageEncoding encoding, const MessageOrigin& origin);
/// Decodes a cloud without its data from the first bytes of a message of `size` bytes. Throws FileError if these bytes
/// are too few.
CloudMessage decodeCloudStart(std::string_view start, std::size_t size, MessageEncoding encoding,
                              const MessageOrigin& origin);
LaserMessage decodeLaser(std::string_view message, MessageEncoding encoding, const MessageOrigin& origin);
OldCloudMessage decodeOldCloud(std::string_view message, MessageEncoding encoding, const MessageOrigin& origin);

/// Returns the transforms of a tf2_msgs/TFMessage or tf/tfMessage.
std::vector<StampedTransform> decodeTransforms(std::string_view message, MessageEncoding encoding,
                                               const MessageOrigin& origin);

/// Returns true for the two types of tf: tf2_msgs/TFMessage and tf/tfMessage.
bool isTransformType(const std::string& type);

/// Returns true if decodePoses() reads this type: nav_msgs/Odometry, nav_msgs/Path, and geometry_msgs/PoseStamped,
/// PoseWithCovarianceStamped and TransformStamped.
bool isPoseType(const std::string& type);

/// Returns the poses of a message: several of a nav_msgs/Path, else one.
std::vector<StampedTransform> decodePoses(const std::string& type, std::string_view message, MessageEncoding encoding,
                                          const MessageOrigin& origin);

/// Returns true if headerOf() reads this type.
bool hasHeader(const std::string& type);

/// Returns the header of a message whose type begins with one, or of the first transform of a TFMessage. Returns
/// std::nullopt if the type is not known.
std::optional<MessageHeader> headerOf(const std::string& type, std::string_view message, MessageEncoding encoding,
                                      const MessageOrigin& origin);

}  // namespace gaussmap::detail
