// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/bag_scans.h"

#include "io/messages/bag_fixture.h"
#include "io/messages/bag_topics.h"

namespace gaussmap::test {
namespace {

class BagScansTest : public BagTest {};

TEST_F(BagScansTest, SayThatCloudsHaveRoomForMorePoints) {
  const std::size_t index = bag_->addTopic("/points", "sensor_msgs/PointCloud2");
  CloudBytes cloud;
  cloud.width = 1;
  cloud.height = 1;
  cloud.row_step = 2 * cloud.point_step;
  bag_->add(index, kStart, cloud.at(kStart));
  EXPECT_TRUE(has(warningsOf(*open()), "room for more points than their width says")) << warningsOf(*open());
}

TEST_F(BagScansTest, NameThePacketsOfALidar) {
  bag_->add(bag_->addTopic("/velodyne_packets", "velodyne_msgs/VelodyneScan"), kStart, "x");
  expectComplaint(complaint({}), "drive.bag", {"/velodyne_packets holds the packets of a lidar"});
}

TEST_F(BagScansTest, RefuseTimesThatStepBack) {
  clouds();
  clouds();  // simulated time starts again
  movingTransform("odom", "lidar");
  expectComplaint(complaint({}), "drive.bag", {"the times in the headers of /points step back by 0.", "--log-times"});
}

TEST_F(BagScansTest, UseTheTimesOfRecordingIfTheHeadersHaveNone) {
  const std::size_t index = bag_->addTopic("/points", "sensor_msgs/PointCloud2");
  for (int i = 0; i < 3; ++i) bag_->add(index, kStart + i, CloudBytes().at(0.0));
  const auto scans = open();
  EXPECT_EQ(scans->info(2).name, "/points 1700000002.000000000");
  EXPECT_TRUE(has(warningsOf(*scans), "3 scans have no time in the header"));
}

TEST_F(BagScansTest, UseTheTimesOfRecordingIfAsked) {
  const std::size_t index = bag_->addTopic("/points", "sensor_msgs/PointCloud2");
  for (int i = 0; i < 10; ++i) bag_->add(index, kStart + 0.1 * i, CloudBytes().at(12.0 + 0.1 * i));
  movingTransform("odom", "lidar");
  EXPECT_FALSE(open()->info(0).pose);
  BagOptions options;
  options.log_times = true;
  expectMotion(*open(options), 0.05);
}

TEST_F(BagScansTest, AskForATopicIfSeveralHaveScans) {
  clouds("/front/points");
  clouds("/rear/points");
  bag_->addTopic("/empty", "sensor_msgs/PointCloud2");
  bag_->addTopic("/imu", "sensor_msgs/Imu");
  expectComplaint(complaint({}), "drive.bag",
                  {"has several topics with scans: /front/points (sensor_msgs/PointCloud2, 10 messages), /rear/points "
                   "(sensor_msgs/PointCloud2, 10 messages); choose one with --topic /front/points"});
  BagOptions options;
  options.topic = "rear/points";
  EXPECT_EQ(open(options)->info(0).name, "/rear/points 1700000000.000000000");
  options.topic = "/imu";
  expectComplaint(complaint(options), "drive.bag", {"topic /imu (sensor_msgs/Imu, 0 messages) holds no scans"});
  options.topic = "/empty";
  expectComplaint(complaint(options), "drive.bag", {"topic /empty has no messages"});
  options.topic = "/none";
  expectComplaint(complaint(options), "drive.bag", {"has no topic /none; topics with scans: /front/points"});
}

TEST_F(BagScansTest, TakeALaserIfThereIsNoCloud) {
  WireBytes laser;
  laser.header(kStart, "laser");
  for (const float value : {0.0f, 1.0f, 0.5f, 0.0f, 0.1f, 0.1f, 9.0f}) laser.put(value);
  laser.put(std::uint32_t{1}).put(2.0f).put(std::uint32_t{0});
  bag_->addTopic("/points", "sensor_msgs/PointCloud2");
  bag_->add(bag_->addTopic("/scan", "sensor_msgs/LaserScan"), kStart, laser.str());
  EXPECT_EQ(open()->kind(), "memory, sensor_msgs/LaserScan");
  bag_ = std::make_unique<MemoryMessages>();
  bag_->addTopic("/velodyne_packets", "velodyne_msgs/VelodyneScan", MessageEncoding::Other);
  expectComplaint(complaint({}), "drive.bag",
                  {"has no messages of sensor_msgs/PointCloud2 or sensor_msgs/LaserScan; topics: /velodyne_packets"});
}

TEST_F(BagScansTest, NameTheMessageThatIsDamaged) {
  clouds();
  bag_->add(bag_->addTopic("/tf", "tf2_msgs/TFMessage"), kStart, "ab");
  expectComplaint(complaint({}), "drive.bag",
                  {"/tf, message recorded at 1700000000.000000000: transforms needs 4 bytes"});
}

TEST_F(BagScansTest, HaveASummary) {
  clouds();
  movingTransform("odom", "base");
  bag_->addTopic("/points", "sensor_msgs/PointCloud2");  // a second node
  bag_->add(bag_->addTopic("/pose", "geometry_msgs/PoseStamped"), kStart + 1.0, "ab");
  bag_->addTopic("/imu", "sensor_msgs/Imu");
  const detail::BagSummary summary = detail::bagSummary(*bag_, "drive.bag");
  ASSERT_EQ(summary.topics.size(), 4u);
  const detail::BagTopicSummary& points = summary.topics[0];
  EXPECT_EQ(points.name, "/points");
  EXPECT_EQ(points.messages, 10u);
  EXPECT_EQ(points.frame, "lidar");
  EXPECT_EQ(points.first.value().count(), 1700000000000000000);
  EXPECT_EQ(summary.topics[1].frame, "odom");
  EXPECT_EQ(summary.topics[2].frame, "");
  EXPECT_FALSE(summary.topics[3].first);
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_TRUE(has(summary.warnings[0], "/pose, message recorded at")) << summary.warnings[0];
}

}  // namespace
}  // namespace gaussmap::test
