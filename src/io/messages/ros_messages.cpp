// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/ros_messages.h"

#include <algorithm>
#include <array>

namespace gaussmap::detail {
namespace {

// The fewest bytes that structures of variable size take.
constexpr std::size_t kLeastField = 13, kLeastChannel = 8, kLeastTransform = 72, kLeastPose = 68;

constexpr std::array<std::string_view, 5> kPoseTypes = {
    "nav_msgs/Odometry", "nav_msgs/Path", "geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped",
    "geometry_msgs/TransformStamped"};

// Types that begin with a header, besides those that have a decoder.
constexpr std::array<std::string_view, 22> kTypesWithHeader = {"sensor_msgs/PointCloud2",
                                                               "sensor_msgs/LaserScan",
                                                               "sensor_msgs/PointCloud",
                                                               "sensor_msgs/MultiEchoLaserScan",
                                                               "sensor_msgs/Imu",
                                                               "sensor_msgs/Image",
                                                               "sensor_msgs/CompressedImage",
                                                               "sensor_msgs/CameraInfo",
                                                               "sensor_msgs/NavSatFix",
                                                               "sensor_msgs/MagneticField",
                                                               "sensor_msgs/FluidPressure",
                                                               "sensor_msgs/Temperature",
                                                               "sensor_msgs/Range",
                                                               "sensor_msgs/JointState",
                                                               "geometry_msgs/TwistStamped",
                                                               "geometry_msgs/AccelStamped",
                                                               "geometry_msgs/PointStamped",
                                                               "geometry_msgs/Vector3Stamped",
                                                               "geometry_msgs/QuaternionStamped",
                                                               "geometry_msgs/TwistWithCovarianceStamped",
                                                               "geometry_msgs/PoseArray",
                                                               "nav_msgs/OccupancyGrid"};

template <std::size_t N>
bool isAmong(const std::array<std::string_view, N>& types, std::string_view type) {
  return std::find(types.begin(), types.end(), type) != types.end();
}

/// geometry_msgs/Pose and geometry_msgs/Transform: both are x y z, then the quaternion x y z w.
Pose decodePose(WireReader& reader) {
  std::array<double, 7> v{};
  for (double& value : v) value = reader.number<double>("the pose");
  Pose pose;
  pose.translation = {v[0], v[1], v[2]};
  pose.rotation = Pose::Rotation(v[6], v[3], v[4], v[5]);
  return pose;
}

StampedTransform decodeTransform(WireReader& reader) {
  MessageHeader header = decodeHeader(reader);
  std::string child(reader.string("child_frame_id"));
  return {header.stamp, std::move(header.frame), std::move(child), decodePose(reader)};
}

StampedTransform decodePoseStamped(WireReader& reader) {
  MessageHeader header = decodeHeader(reader);
  return {header.stamp, std::move(header.frame), "", decodePose(reader)};
}

std::vector<StampedTransform> decodePath(WireReader& reader) {
  const MessageHeader header = decodeHeader(reader);
  const std::size_t count = reader.structures("poses", kLeastPose);
  std::vector<StampedTransform> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back(decodePoseStamped(reader));
    if (poses.back().parent.empty()) poses.back().parent = header.frame;
  }
  return poses;
}

}  // namespace

MessageHeader decodeHeader(WireReader& reader) {
  MessageHeader header;
  std::int64_t seconds = 0;
  if (reader.isRos1()) {
    reader.number<std::uint32_t>("header.seq");
    seconds = reader.number<std::uint32_t>("header.stamp");
  } else {
    seconds = reader.number<std::int32_t>("header.stamp");
  }
  header.stamp = std::chrono::seconds(seconds) + std::chrono::nanoseconds(reader.number<std::uint32_t>("header.stamp"));
  header.frame = std::string(reader.string("header.frame_id"));
  return header;
}

namespace {

/// Decodes everything before the data.
CloudMessage decodeCloudHead(WireReader& reader) {
  CloudMessage cloud;
  cloud.header = decodeHeader(reader);
  cloud.height = reader.number<std::uint32_t>("height");
  cloud.width = reader.number<std::uint32_t>("width");
  cloud.fields.resize(reader.structures("fields", kLeastField));
  for (CloudField& field : cloud.fields) {
    field.name = reader.string("the name of a field");
    field.offset = reader.number<std::uint32_t>("the offset of a field");
    field.datatype = reader.number<std::uint8_t>("the datatype of a field");
    field.count = reader.number<std::uint32_t>("the count of a field");
  }
  cloud.big_endian = reader.boolean("is_bigendian");
  cloud.point_step = reader.number<std::uint32_t>("point_step");
  cloud.row_step = reader.number<std::uint32_t>("row_step");
  cloud.data_size = reader.number<std::uint32_t>("data");
  return cloud;
}

}  // namespace

CloudMessage decodeCloud(std::string_view message, MessageEncoding encoding, const MessageOrigin& origin) {
  WireReader reader(message, encoding, origin);
  CloudMessage cloud = decodeCloudHead(reader);
  cloud.data = reader.bytes(cloud.data_size, "data");
  reader.boolean("is_dense");
  reader.requireEnd();
  return cloud;
}

CloudMessage decodeCloudStart(std::string_view start, std::size_t size, MessageEncoding encoding,
                              const MessageOrigin& origin) {
  WireReader reader(start, encoding, origin);
  CloudMessage cloud = decodeCloudHead(reader);
  const std::size_t left = size - start.size() + reader.left(), needed = cloud.data_size + sizeof(std::uint8_t);
  if (left < needed || !reader.canEnd(left - needed))
    reader.fail("the size of the data contradicts that of the message");
  return cloud;
}

LaserMessage decodeLaser(std::string_view message, MessageEncoding encoding, const MessageOrigin& origin) {
  WireReader reader(message, encoding, origin);
  LaserMessage laser;
  laser.header = decodeHeader(reader);
  laser.angle_min = reader.number<float>("angle_min");
  reader.number<float>("angle_max");
  laser.angle_increment = reader.number<float>("angle_increment");
  laser.time_increment = reader.number<float>("time_increment");
  reader.number<float>("scan_time");
  laser.range_min = reader.number<float>("range_min");
  laser.range_max = reader.number<float>("range_max");
  laser.ranges = reader.floats("ranges");
  laser.intensities = reader.floats("intensities");
  reader.requireEnd();
  return laser;
}

OldCloudMessage decodeOldCloud(std::string_view message, MessageEncoding encoding, const MessageOrigin& origin) {
  WireReader reader(message, encoding, origin);
  OldCloudMessage cloud;
  cloud.header = decodeHeader(reader);
  cloud.coordinates = reader.triples("points");
  const std::size_t channels = reader.structures("channels", kLeastChannel);
  cloud.channels.reserve(channels);
  for (std::size_t i = 0; i < channels; ++i) {
    const std::string_view name = reader.string("the name of a channel");
    cloud.channels.emplace_back(name, reader.floats("the values of a channel"));
  }
  reader.requireEnd();
  return cloud;
}

std::vector<StampedTransform> decodeTransforms(std::string_view message, MessageEncoding encoding,
                                               const MessageOrigin& origin) {
  WireReader reader(message, encoding, origin);
  const std::size_t count = reader.structures("transforms", kLeastTransform);
  std::vector<StampedTransform> transforms;
  transforms.reserve(count);
  for (std::size_t i = 0; i < count; ++i) transforms.push_back(decodeTransform(reader));
  reader.requireEnd();
  return transforms;
}

bool isTransformType(const std::string& type) {
  return type == "tf2_msgs/TFMessage" || type == "tf/tfMessage";
}

bool isPoseType(const std::string& type) {
  return isAmong(kPoseTypes, type);
}

std::vector<StampedTransform> decodePoses(const std::string& type, std::string_view message, MessageEncoding encoding,
                                          const MessageOrigin& origin) {
  WireReader reader(message, encoding, origin);
  std::vector<StampedTransform> poses;
  if (type == "nav_msgs/Path") {
    poses = decodePath(reader);
  } else if (type == "geometry_msgs/PoseStamped") {
    poses.push_back(decodePoseStamped(reader));
  } else if (type == "geometry_msgs/PoseWithCovarianceStamped") {
    poses.push_back(decodePoseStamped(reader));
    reader.skipDoubles(36, "the covariance");
  } else if (type == "geometry_msgs/TransformStamped") {
    poses.push_back(decodeTransform(reader));
  } else if (type == "nav_msgs/Odometry") {
    poses.push_back(decodeTransform(reader));
    reader.skipDoubles(36 + 6 + 36, "the covariance and the twist");
  } else {
    reader.fail("the type " + type + " holds no poses that gaussmap can read");
  }
  reader.requireEnd();
  return poses;
}

bool hasHeader(const std::string& type) {
  return isTransformType(type) || isPoseType(type) || isAmong(kTypesWithHeader, type);
}

std::optional<MessageHeader> headerOf(const std::string& type, std::string_view message, MessageEncoding encoding,
                                      const MessageOrigin& origin) {
  if (!hasHeader(type)) return std::nullopt;
  WireReader reader(message, encoding, origin);
  if (isTransformType(type) && reader.structures("transforms", kLeastTransform) == 0) return std::nullopt;
  return decodeHeader(reader);
}

}  // namespace gaussmap::detail
