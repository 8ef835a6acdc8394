// SPDX-License-Identifier: BSD-3-Clause
// Messages of ROS 1 and ROS 2. The first byte chooses the type, the second one the encoding.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz_file.h"
#include "io/messages/message_scans.h"
#include "io/messages/ros_messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  using namespace gaussmap::detail;
  static const std::array<std::string, 10> types = {"sensor_msgs/PointCloud2",
                                                    "sensor_msgs/LaserScan",
                                                    "sensor_msgs/PointCloud",
                                                    "tf2_msgs/TFMessage",
                                                    "nav_msgs/Odometry",
                                                    "nav_msgs/Path",
                                                    "geometry_msgs/PoseStamped",
                                                    "geometry_msgs/PoseWithCovarianceStamped",
                                                    "geometry_msgs/TransformStamped",
                                                    "sensor_msgs/Imu"};
  if (size < 2) return 0;
  const std::string& type = types[data[0] % types.size()];
  const MessageEncoding encoding = data[1] % 2 == 0 ? MessageEncoding::Ros1 : MessageEncoding::Cdr;
  const std::vector<char> bytes(data + 2, data + size);
  const std::string_view message(bytes.data(), bytes.size());
  const MessageOrigin origin{"bag", "/topic", std::chrono::nanoseconds(1)};
  fuzz::refusesOrReads([&] { headerOf(type, message, encoding, origin); });
  fuzz::refusesOrReads([&] {
    if (isTransformType(type)) decodeTransforms(message, encoding, origin);
    if (isPoseType(type)) decodePoses(type, message, encoding, origin);
    if (!isScanType(type)) return;
    const MessageScanSize about = scanSize(type, message, encoding, origin);
    if (isCloudType(type)) {
      const MessageStart start{{bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2)},
                               bytes.size()};
      const auto same = scanSizeOfStart(start, encoding, origin);
      if (same && same->points != about.points) std::abort();
    }
    const auto reader = readScan(type, bytes, encoding, origin);
    if (reader->size() != about.points) std::abort();
    PointBlock<3> block;
    std::size_t count = 0;
    for (reader->read(0, block); block.size > 0; reader->read(count, block)) count += block.size;
    if (count != about.points) std::abort();
    for (const std::string& name : reader->valueNames())
      if (reader->values(name).size() != about.points) std::abort();
  });
  return 0;
}
