// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "io/files/hostile_files.h"
#include "io/messages/bag_scans.h"
#include "io/messages/memory_messages.h"

namespace gaussmap::test {

using detail::BagOptions;
using detail::BagPoses;
using detail::FileScanInfo;
using detail::ScanFile;

inline constexpr double kStart = 1700000000.0;

/// Ten clouds, 0.1 s apart, of a robot that moves with 1 m/s.
class BagTest : public testing::Test {
 protected:
  BagTest() : bag_(std::make_unique<MemoryMessages>()) {}

  void clouds(const std::string& topic = "/points", const std::string& frame = "lidar", double first = kStart) {
    const std::size_t index = bag_->addTopic(topic, "sensor_msgs/PointCloud2");
    CloudBytes cloud;
    cloud.frame = frame;
    for (int i = 0; i < 10; ++i) bag_->add(index, first + 0.1 * i, cloud.at(first + 0.1 * i));
  }
  void staticTransform(const std::string& parent, const std::string& child, const Pose& pose) {
    bag_->add(bag_->addTopic("/tf_static", "tf2_msgs/TFMessage"), kStart, transformBytes(0.0, parent, child, pose));
  }
  void movingTransform(const std::string& parent, const std::string& child, double first = kStart - 0.05) {
    const std::size_t index = bag_->addTopic("/tf", "tf2_msgs/TFMessage");
    for (int i = 0; i < 12; ++i)
      bag_->add(index, first + 0.1 * i, transformBytes(first + 0.1 * i, parent, child, poseAt(0.1 * i)));
  }
  void odometry(const std::string& topic, const std::string& parent, const std::string& child) {
    const std::size_t index = bag_->addTopic(topic, "nav_msgs/Odometry");
    for (int i = 0; i < 12; ++i)
      bag_->add(index, kStart, odometryBytes(kStart - 0.05 + 0.1 * i, parent, child, poseAt(0.1 * i)));
  }
  std::unique_ptr<ScanFile> open(const BagOptions& options = {}) {
    return openBagScans(std::make_unique<MemoryMessages>(*bag_), "drive.bag", options);
  }
  std::string complaint(const BagOptions& options) {
    return complaintOf([&] { open(options); });
  }
  static std::string warningsOf(const ScanFile& scans) {
    std::string all;
    for (const std::string& warning : scans.warnings()) all += warning + "\n";
    return all;
  }
  /// Expects the pose `offset` + 0.1 m per scan.
  static void expectMotion(const ScanFile& scans, double offset) {
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const FileScanInfo info = scans.info(i);
      ASSERT_TRUE(info.pose) << i << "\n" << warningsOf(scans);
      EXPECT_NEAR(info.pose->translation.x(), offset + 0.1 * static_cast<double>(i), 1e-9);
    }
  }

  std::unique_ptr<MemoryMessages> bag_;
};

inline BagOptions fromTf() {
  BagOptions options;
  options.poses = BagPoses::Tf;
  return options;
}
inline BagOptions fromTopic(const std::string& topic) {
  BagOptions options;
  options.poses = BagPoses::Topic;
  options.pose_topic = topic;
  return options;
}
inline bool has(const std::string& text, const std::string& piece) {
  return text.find(piece) != std::string::npos;
}

}  // namespace gaussmap::test
