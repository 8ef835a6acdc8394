// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/bag_poses.h"

#include "io/messages/bag_fixture.h"

namespace gaussmap::test {
namespace {

class BagPosesTest : public BagTest {};

TEST_F(BagPosesTest, HavePosesOfTransforms) {
  clouds();
  staticTransform("base_link", "lidar", poseAt(1.0));
  movingTransform("odom", "base_link");
  for (const BagOptions& options : {BagOptions(), fromTf(), fromTopic("tf")}) {
    const auto scans = open(options);
    ASSERT_EQ(scans->size(), 10u);
    EXPECT_EQ(scans->kind(), "memory, sensor_msgs/PointCloud2");
    EXPECT_EQ(scans->poseSource(), "tf: lidar in odom");
    EXPECT_EQ(warningsOf(*scans), "");
    expectMotion(*scans, 1.05);
    const FileScanInfo info = scans->info(1);
    EXPECT_EQ(info.name, "/points 1700000000.100000000");
    EXPECT_EQ(info.time->count(), 1700000000100000000);
    EXPECT_EQ(info.points, 2u);
    EXPECT_EQ(scans->open(1)->size(), 2u);
  }
}

TEST_F(BagPosesTest, PreferMapOverOdomOverTheRoot) {
  clouds();
  movingTransform("odom", "lidar");
  staticTransform("map", "odom", poseAt(100.0));
  staticTransform("utm", "map", poseAt(1e6));
  expectMotion(*open(), 100.05);
  BagOptions options;
  options.fixed_frame = "/utm";
  EXPECT_EQ(open(options)->poseSource(), "tf: lidar in utm");
  expectMotion(*open(options), 1000100.05);
  options.fixed_frame = "mars";
  options.poses = BagPoses::Tf;
  expectComplaint(complaint(options), "drive.bag",
                  {"--fixed-frame mars: tf has no such frame; the frames are lidar, map, odom, utm"});
}

TEST_F(BagPosesTest, HavePosesOfOdometryAndTheStaticTransformToTheSensor) {
  clouds();
  odometry("/odom", "odom", "base_link");
  staticTransform("base_link", "lidar", poseAt(2.0));
  for (const BagOptions& options : {BagOptions(), fromTopic("odom")}) {
    const auto scans = open(options);
    EXPECT_EQ(scans->poseSource(), "/odom (nav_msgs/Odometry): base_link in odom, then base_link -> lidar of tf");
    EXPECT_EQ(warningsOf(*scans), "");
    expectMotion(*scans, 2.05);
  }
}

TEST_F(BagPosesTest, PreferOdometryOverTransformsOnTheRobot) {
  clouds();
  odometry("/odom", "odom", "base_link");
  movingTransform("base_link", "lidar");  // a sensor that is moved
  const auto scans = open();
  EXPECT_TRUE(has(scans->poseSource(), "/odom")) << scans->poseSource();
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(scans->info(i).pose.value().translation.x(), 0.1 + 0.2 * static_cast<double>(i), 1e-9);
}

TEST_F(BagPosesTest, NeedAnExtrinsicIfNothingSaysWhereTheSensorIs) {
  clouds();
  odometry("/odom", "odom", "base_link");
  expectComplaint(
      complaint({}), "drive.bag",
      {"/odom gives the poses of base_link, but the recording has no tf that gives the pose of lidar in base_link; "
       "give its pose in base_link with --extrinsic"});
  BagOptions options;
  options.has_extrinsic = true;  // the caller moves the poses
  expectMotion(*open(options), 0.05);
  staticTransform("base_link", "camera", poseAt(1.0));
  expectComplaint(complaint({}), "drive.bag",
                  {"tf does not give the pose of lidar in base_link (the frames of tf are base_link, camera)"});
}

TEST_F(BagPosesTest, ReplaceTheTransformOfTfByAnExtrinsic) {
  clouds();
  odometry("/odom", "odom", "base_link");
  staticTransform("base_link", "lidar", poseAt(2.0));
  BagOptions options;
  options.has_extrinsic = true;
  expectMotion(*open(options), 0.05);
}

TEST_F(BagPosesTest, TakeThePosesOfAFrameOfTfIfTheScansHaveNone) {
  clouds("/points", "velodyne");
  movingTransform("odom", "base_link");
  EXPECT_TRUE(has(open()->missingPoses().reason, "no transform in tf has the frame velodyne"));
  EXPECT_TRUE(has(open()->missingPoses().advice, "--poses tf --pose-frame NAME --extrinsic"));
  BagOptions options = fromTf();
  options.pose_frame = "base_link";
  expectComplaint(complaint(options), "drive.bag", {"tf does not give the pose of velodyne in ", "--extrinsic"});
  options.has_extrinsic = true;
  EXPECT_EQ(open(options)->poseSource(), "tf: base_link in odom");
  expectMotion(*open(options), 0.05);
  options.pose_frame = "nonsense";
  expectComplaint(complaint(options), "drive.bag",
                  {"--pose-frame nonsense: tf has no such frame; the frames are base_link, odom"});
}

TEST_F(BagPosesTest, KnowFixedFramesWithANamespace) {
  clouds("/points", "robot1/lidar");
  odometry("/odom", "robot1/odom", "robot1/base_link");
  staticTransform("robot1/base_link", "robot1/lidar", poseAt(1.0));
  movingTransform("robot1/odom", "robot1/base_link");
  staticTransform("robot1/map", "robot1/odom", poseAt(100.0));
  EXPECT_EQ(open()->poseSource(), "tf: robot1/lidar in robot1/map");
  EXPECT_EQ(open()->mapFrame(), "robot1/map");
  expectMotion(*open(), 101.05);
}

TEST_F(BagPosesTest, PreferOdometryOverTransformsThatOnlyRepeat) {
  clouds();
  const std::size_t tf = bag_->addTopic("/tf", "tf2_msgs/TFMessage");  // a static transform in the way of ROS 1
  for (int i = 0; i < 12; ++i)
    bag_->add(tf, kStart + 0.1 * i, transformBytes(kStart + 0.1 * i, "map", "lidar", poseAt(7.0)));
  EXPECT_TRUE(has(open()->missingPoses().reason, "the transform from lidar to map in tf never changes"))
      << open()->missingPoses().reason;
  odometry("/odom", "odom", "lidar");
  EXPECT_EQ(open()->poseSource(), "/odom (nav_msgs/Odometry): lidar in odom");
  expectMotion(*open(), 0.05);
}

TEST_F(BagPosesTest, PreferTransformsInWhichTheRobotMovesWhateverTheirRoot) {
  clouds("/points", "base_link");
  movingTransform("vicon", "base_link");
  odometry("/odom", "odom", "base_link");
  EXPECT_EQ(open()->poseSource(), "tf: base_link in vicon");
}

TEST_F(BagPosesTest, GiveMountingsForPosesFromElsewhere) {
  clouds();
  staticTransform("base_link", "lidar", poseAt(2.0));
  BagOptions options;
  options.poses = BagPoses::None;
  options.pose_frame = "base_link";
  const auto scans = open(options);
  EXPECT_FALSE(scans->info(3).pose);
  EXPECT_EQ(scans->info(3).sensor_in_pose_frame.value().translation.x(), 2.0);
  options.pose_frame = "robot";
  expectComplaint(complaint(options), "drive.bag", {"--pose-frame robot: tf has no such frame"});
}

TEST_F(BagPosesTest, SayThatPosesAreFromOtherTimes) {
  clouds("/points", "base_link");
  odometry("/odom", "odom", "base_link");
  EXPECT_EQ(warningsOf(*open()), "");
  bag_ = std::make_unique<MemoryMessages>();
  clouds("/points", "base_link", kStart - 0.08);  // the first scan is before the first pose
  odometry("/odom", "odom", "base_link");
  EXPECT_TRUE(has(warningsOf(*open()), "1 of 10 scans has the pose of another time, at most 0.03"))
      << warningsOf(*open());
}

TEST_F(BagPosesTest, RefusePosesWhoseTimesStepBack) {
  clouds();
  const std::size_t index = bag_->addTopic("/odom", "nav_msgs/Odometry");
  for (int run = 0; run < 2; ++run)
    for (int i = 0; i < 12; ++i)
      bag_->add(index, kStart + 0.1 * i, odometryBytes(kStart + 0.1 * i, "odom", "lidar", poseAt(0.1 * i + run)));
  expectComplaint(complaint({}), "drive.bag", {"the times of /odom step back by", "--log-times"});
}

TEST_F(BagPosesTest, NameDifferentClocks) {
  clouds("/points", "lidar", 12.0);
  movingTransform("odom", "lidar");
  EXPECT_TRUE(has(open()->missingPoses().reason, "10 of 10 scans have no pose"));
  EXPECT_TRUE(has(open()->missingPoses().advice, "different clocks: use --log-times")) << open()->missingPoses().advice;
}

TEST_F(BagPosesTest, HavePosesOfEveryType) {
  clouds();
  const std::size_t pose = bag_->addTopic("/pose", "geometry_msgs/PoseStamped");
  const std::size_t covariance = bag_->addTopic("/covariance", "geometry_msgs/PoseWithCovarianceStamped");
  const std::size_t transform = bag_->addTopic("/transform", "geometry_msgs/TransformStamped");
  for (int i = 0; i < 11; ++i) {
    const double time = kStart + 0.1 * i;
    bag_->add(pose, time, poseBytes(time, "map", poseAt(0.1 * i)));
    bag_->add(covariance, time, WireBytes().header(time, "map").pose(poseAt(0.1 * i)).zeros(36).str());
    bag_->add(transform, time, WireBytes().header(time, "map").text("lidar").pose(poseAt(0.1 * i)).str());
  }
  const std::size_t path = bag_->addTopic("/path", "nav_msgs/Path");
  for (const std::uint32_t count : {3u, 11u}) {  // the first one is wrong: only the last one counts
    WireBytes bytes;
    bytes.header(kStart, "map").put(count);
    for (std::uint32_t i = 0; i < count; ++i)
      bytes.header(kStart + 0.1 * i, "map").pose(poseAt(count == 3 ? 77.0 : 0.1 * i));
    bag_->add(path, kStart + 2.0, bytes.str());
  }
  for (const char* const topic : {"/pose", "/covariance", "/transform", "path"}) {
    SCOPED_TRACE(topic);
    const auto scans = open(fromTopic(topic));
    expectMotion(*scans, 0.0);
    EXPECT_EQ(has(warningsOf(*scans), "does not say whose poses it gives"), std::string(topic) != "/transform");
  }
  EXPECT_TRUE(
      has(open()->missingPoses().reason,
          "no poses: it is not clear which topic gives the poses of the sensor: /pose (geometry_msgs/PoseStamped, 11"));
  EXPECT_FALSE(open()->info(0).pose);
}

TEST_F(BagPosesTest, UseThePoseFrameThatIsGiven) {
  clouds();
  const std::size_t pose = bag_->addTopic("/pose", "geometry_msgs/PoseStamped");
  for (int i = 0; i < 11; ++i) bag_->add(pose, kStart, poseBytes(kStart + 0.1 * i, "map", poseAt(0.1 * i)));
  staticTransform("base_link", "lidar", poseAt(3.0));
  BagOptions options = fromTopic("/pose");
  options.pose_frame = "base_link";
  const auto scans = open(options);
  expectMotion(*scans, 3.0);
  EXPECT_EQ(warningsOf(*scans), "");
}

TEST_F(BagPosesTest, LeavePointsInAFixedFrameWhereTheyAre) {
  clouds("/cloud_registered", "camera_init");
  odometry("/Odometry", "camera_init", "body");
  for (const bool has_tf : {false, true}) {
    if (has_tf) movingTransform("camera_init", "body");
    const auto scans = open();
    EXPECT_EQ(scans->info(5).pose.value().translation.norm(), 0.0);
    EXPECT_EQ(scans->poseSource(),
              "none needed: the points of /cloud_registered are in the fixed frame camera_init; the positions of "
              "the sensor are unknown");
    EXPECT_TRUE(scans->inMapFrame());
    EXPECT_EQ(warningsOf(*scans), "");
  }
  staticTransform("map", "camera_init", poseAt(7.0));
  EXPECT_EQ(open()->info(5).pose.value().translation.x(), 7.0);
}

TEST_F(BagPosesTest, HavePositionsForPointsInAFixedFrame) {
  clouds("/cloud_registered", "camera_init");
  odometry("/Odometry", "camera_init", "body");
  BagOptions options;
  options.points_in_map = true;
  for (const auto& [poses, topic] : {std::pair(BagPoses::Automatic, ""), std::pair(BagPoses::Topic, "/Odometry")}) {
    options.poses = poses;
    options.pose_topic = topic;
    const auto scans = open(options);
    EXPECT_FALSE(scans->inMapFrame());
    EXPECT_EQ(scans->poseSource(), "positions from /Odometry (nav_msgs/Odometry) in camera_init");
    expectMotion(*scans, 0.05);
  }
}

TEST_F(BagPosesTest, HaveNoPosesIfNoneAreWanted) {
  clouds();
  movingTransform("odom", "lidar");
  BagOptions options;
  options.poses = BagPoses::None;
  EXPECT_FALSE(open(options)->info(0).pose);
  EXPECT_EQ(open(options)->poseSource() + open(options)->missingPoses().reason, "");
}

TEST_F(BagPosesTest, SayWhyThereAreNoPoses) {
  clouds();
  EXPECT_EQ(open()->missingPoses().reason, "no poses: the recording has no odometry, and no tf");
  expectComplaint(complaint(fromTf()), "drive.bag", {"the recording has no messages of tf"});
  staticTransform("base_link", "velodyne", Pose());
  EXPECT_TRUE(
      has(open()->missingPoses().reason, "no transform in tf has the frame lidar (the frames are base_link, velodyne"));
  staticTransform("map", "lidar", Pose());
  EXPECT_TRUE(has(open()->missingPoses().reason, "the transform from lidar to map in tf never changes"));
  const auto scans = open(fromTf());
  EXPECT_TRUE(scans->info(0).pose);
  EXPECT_TRUE(has(warningsOf(*scans), "all scans have the same pose"));
  odometry("/a", "odom", "base_link");
  odometry("/b", "odom", "base_link");
  EXPECT_TRUE(
      has(open()->missingPoses().reason, "/a (nav_msgs/Odometry, 12 messages), /b (nav_msgs/Odometry, 12 messages)"))
      << open()->missingPoses().reason;
  expectComplaint(complaint(fromTopic("/c")), "drive.bag", {"has no topic /c with poses", "/a (nav_msgs/Odometry"});
}

TEST_F(BagPosesTest, SayWhichScansHaveNoPose) {
  clouds();
  movingTransform("odom", "lidar", kStart + 0.15);
  auto scans = open();
  EXPECT_FALSE(scans->info(1).pose);
  EXPECT_TRUE(scans->info(2).pose);
  EXPECT_TRUE(
      has(scans->missingPoses().reason,
          "2 of 10 scans have no pose, first /points 1700000000.000000000: the transform odom -> lidar starts at "
          "1700000000.150000000"))
      << scans->missingPoses().reason;
  BagOptions options;
  options.max_time_gap = 0.06;
  EXPECT_TRUE(open(options)->info(1).pose);
  EXPECT_FALSE(open(options)->info(0).pose);
}

TEST_F(BagPosesTest, TakeNoPoseThatIsTooFarAwayInTime) {
  clouds("/points", "base_link", kStart + 1.0);
  odometry("/odom", "odom", "base_link");
  const auto scans = open();
  EXPECT_TRUE(scans->info(0).pose);
  EXPECT_FALSE(scans->info(2).pose);
  EXPECT_TRUE(
      has(scans->missingPoses().reason,
          "s from the nearest pose, but the limit is 0.050000000 s; the times of the poses are 1699999999.950000000"))
      << scans->missingPoses().reason;
}

TEST_F(BagPosesTest, LeaveOutPosesWithFaults) {
  clouds("/points", "base_link");
  const std::size_t index = bag_->addTopic("/odom", "nav_msgs/Odometry");
  Pose zero;
  zero.rotation.coeffs().setZero();
  bag_->add(index, kStart, odometryBytes(kStart - 0.1, "odom", "base_link", zero));
  for (int i = 0; i < 10; ++i)
    bag_->add(index, kStart, odometryBytes(kStart + 0.1 * i, "odom", "base_link", poseAt(0.1 * i)));
  const auto scans = open();
  expectMotion(*scans, 0.0);
  EXPECT_TRUE(
      has(warningsOf(*scans), "1 poses are left out, first /odom at 1700000000.000000000, the quaternion is zero"))
      << warningsOf(*scans);
}

}  // namespace
}  // namespace gaussmap::test
