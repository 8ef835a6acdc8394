// SPDX-License-Identifier: BSD-3-Clause
// The scans of a recording, their poses and the tree of transforms. The first byte chooses the options. Then the input
// is a list of messages: the topic, the time, two bytes of length, the bytes.
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fuzz_scan_file.h"
#include "io/messages/bag_scans.h"
#include "io/messages/bag_topics.h"

namespace {

using namespace gaussmap;
using namespace gaussmap::detail;

class FuzzedMessages : public MessageFile {
 public:
  FuzzedMessages(const std::uint8_t* data, std::size_t size) : bytes_(data, data + size) {
    constexpr MessageEncoding kRos1 = MessageEncoding::Ros1;
    topics_ = {{"/points", "sensor_msgs/PointCloud2", kRos1, 0},
               {"/tf", "tf2_msgs/TFMessage", kRos1, 0},
               {"/tf_static", "tf2_msgs/TFMessage", kRos1, 0},
               {"/odom", "nav_msgs/Odometry", kRos1, 0},
               {"/path", "nav_msgs/Path", kRos1, 0},
               {"/pose", "geometry_msgs/PoseStamped", MessageEncoding::Cdr, 0},
               {"/scan", "sensor_msgs/LaserScan", MessageEncoding::Cdr, 0}};
    for (std::size_t at = 0; at + 4 <= size;) {
      const std::size_t length = std::min<std::size_t>(data[at + 2] | data[at + 3] << 8, size - at - 4);
      const std::size_t topic = data[at] % topics_.size();
      ++topics_[topic].messages;
      places_.push_back({topic, std::chrono::milliseconds(100 * data[at + 1]), (at + 4) << 16 | length});
      at += 4 + length;
    }
  }
  std::string kind() const override { return "fuzzed"; }
  const std::vector<MessageTopic>& topics() const override { return topics_; }
  const std::vector<MessagePlace>& messages() const override { return places_; }
  std::vector<char> read(const MessagePlace& message) const override {
    const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(message.place >> 16);
    return {first, first + static_cast<std::ptrdiff_t>(message.place & 0xFFFF)};
  }

 private:
  std::vector<char> bytes_;
  std::vector<MessageTopic> topics_;
  std::vector<MessagePlace> places_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const std::array<const char*, 4> pose_topics = {"/odom", "path", "/pose", "/tf"};
  const unsigned chosen = data[0];
  BagOptions options;
  options.poses = static_cast<BagPoses>(chosen % 4);
  options.pose_topic = pose_topics[chosen / 4 % 4];
  if (chosen & 16u) options.fixed_frame = "odom";
  if (chosen & 32u) options.pose_frame = "base";
  if (chosen & 64u) options.max_time_gap = 0.25;
  options.log_times = (chosen & 128u) != 0;
  options.has_extrinsic = chosen % 3 == 0;
  options.points_in_map = chosen % 5 == 0;
  auto file = std::make_unique<FuzzedMessages>(data + 1, size - 1);
  bagSummary(*file, "bag");
  fuzz::refusesOrReads([&] {
    const auto scans = openBagScans(std::move(file), "bag", options);
    fuzz::readScans(*scans);
    for (std::size_t i = 0; i < scans->size(); ++i)
      if (const auto pose = scans->info(i).pose; pose && !poseFault(*pose).empty()) std::abort();
  });
  return 0;
}
