// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/transform_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "gaussmap/core/gaussian.h"
#include "io/messages/memory_messages.h"

namespace gaussmap::detail {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using test::poseAt;

constexpr PoseTimeLimits kLimits{milliseconds(1000), milliseconds(1)};

class TransformTreeTest : public testing::Test {
 protected:
  void dynamic(const std::string& parent, const std::string& child, int ms, const Pose& pose) {
    tree_.add(parent, child, milliseconds(ms), pose, false);
  }
  void fixed(const std::string& parent, const std::string& child, const Pose& pose) {
    tree_.add(parent, child, nanoseconds(0), pose, true);
  }
  std::optional<Pose> pose(const std::string& target, const std::string& source, int ms) {
    reason_.clear();
    const auto chain = tree_.chain(target, source, reason_);
    if (!chain) return std::nullopt;
    PoseLookup lookup;
    const std::optional<Pose> found = tree_.pose(*chain, milliseconds(ms), kLimits, lookup);
    reason_ = lookup.reason;
    return found;
  }
  bool explains(const std::string& piece) const { return reason_.find(piece) != std::string::npos; }

  TransformTree tree_;
  std::string reason_;
};

void expectNear(const std::optional<Pose>& got, const Pose& expected) {
  ASSERT_TRUE(got);
  EXPECT_LT((got->translation - expected.translation).norm(), 1e-12);
  EXPECT_LT(Eigen::Quaterniond(got->rotation).angularDistance(Eigen::Quaterniond(expected.rotation)), 1e-7);
}

TEST_F(TransformTreeTest, InterpolatesAlongTheChain) {
  fixed("/base_link", "lidar", poseAt(1.0));
  dynamic("odom", "base_link", 1000, poseAt(0.0, 0.0));
  dynamic("odom", "/base_link", 2000, poseAt(2.0, 1.0));
  dynamic("map", "odom", 1500, poseAt(10.0));
  dynamic("map", "odom", 1000, poseAt(20.0));  // out of order
  tree_.finish();
  EXPECT_TRUE(tree_.warnings().empty());
  expectNear(pose("odom", "lidar", 1250), poseAt(0.5, 0.25) * poseAt(1.0));
  expectNear(pose("map", "/lidar", 1250), poseAt(15.0) * poseAt(0.5, 0.25) * poseAt(1.0));
  expectNear(pose("lidar", "map", 1250), (poseAt(15.0) * poseAt(0.5, 0.25) * poseAt(1.0)).inverse());
  expectNear(pose("lidar", "lidar", 0), Pose());
  EXPECT_EQ(tree_.above("lidar"), (std::vector<std::string>{"base_link", "odom", "map"}));
  EXPECT_EQ(tree_.frames(), "base_link, lidar, map, odom");
}

TEST_F(TransformTreeTest, ConnectsBranches) {
  fixed("base", "lidar", poseAt(1.0));
  fixed("base", "camera", poseAt(0.0, 2.0));
  dynamic("odom", "base", 0, poseAt(0.0));
  dynamic("odom", "base", 100, poseAt(1.0));
  tree_.finish();
  expectNear(pose("camera", "lidar", 99999), poseAt(0.0, 2.0).inverse() * poseAt(1.0));  // odom is not needed
  std::string reason;
  EXPECT_FALSE(tree_.chain("camera", "lidar", reason)->moves);
  EXPECT_TRUE(tree_.chain("odom", "lidar", reason)->moves);
}

TEST_F(TransformTreeTest, DoesNotExtrapolateOrBridgeGaps) {
  dynamic("odom", "base", 1000, poseAt(0.0));
  dynamic("odom", "base", 1100, poseAt(1.0));
  dynamic("odom", "base", 3000, poseAt(2.0));
  tree_.finish();
  EXPECT_FALSE(pose("odom", "base", 998));
  EXPECT_TRUE(explains("the transform odom -> base starts at 1.000000000")) << reason_;
  EXPECT_TRUE(pose("odom", "base", 999));
  EXPECT_FALSE(pose("odom", "base", 3002));
  EXPECT_TRUE(explains("ends at 3.000000000")) << reason_;
  EXPECT_FALSE(pose("odom", "base", 1300));
  EXPECT_TRUE(explains("has a gap there: the nearest is 0.200000000 s away")) << reason_;
  expectNear(pose("odom", "base", 3000), poseAt(2.0));
  expectNear(pose("odom", "base", 1101), poseAt(1.0));
}

TEST_F(TransformTreeTest, TakesTheLastOfSeveralPosesAtOneTime) {
  dynamic("odom", "base", 1000, poseAt(5.0));
  dynamic("odom", "base", 2000, poseAt(7.0));
  dynamic("odom", "base", 1000, poseAt(6.0));
  tree_.finish();
  expectNear(pose("odom", "base", 1000), poseAt(6.0));
}

TEST_F(TransformTreeTest, KeepsTransformsThatNeverChange) {
  dynamic("base", "lidar", 1000, poseAt(3.0, 0.5));
  dynamic("base", "lidar", 2000, poseAt(3.0, 0.5));
  tree_.finish();
  expectNear(pose("base", "lidar", 90000), poseAt(3.0, 0.5));
}

TEST_F(TransformTreeTest, WarnsOfSeveralParentsAndOfStaticTransformsThatChange) {
  dynamic("odom", "base", 0, poseAt(1.0));
  dynamic("wheels", "base", 1, poseAt(2.0));
  dynamic("odom", "base", 2, poseAt(1.0));
  fixed("base", "lidar", poseAt(1.0));
  fixed("base", "lidar", poseAt(2.0));
  tree_.finish();
  ASSERT_EQ(tree_.warnings().size(), 2u);
  EXPECT_EQ(tree_.warnings()[0], "frame base has the parents wheels and odom. The last one in the recording is used");
  EXPECT_EQ(tree_.warnings()[1],
            "the static transform base -> lidar is given with different values. The last one is used");
  expectNear(pose("odom", "lidar", 0), poseAt(3.0));
  EXPECT_FALSE(pose("wheels", "lidar", 0));
  EXPECT_TRUE(
      explains("do not connect lidar (below odom) with wheels (below wheels); the frames are base, lidar, odom"))
      << reason_;
}

TEST_F(TransformTreeTest, NamesMissingFramesAndCycles) {
  fixed("a", "b", Pose());
  fixed("b", "c", Pose());
  fixed("c", "a", Pose());
  fixed("map", "base", Pose());
  tree_.finish();
  EXPECT_FALSE(pose("map", "lidar", 0));
  EXPECT_TRUE(explains("no transform has the frame lidar; the frames are a, b, base, c, map")) << reason_;
  EXPECT_FALSE(pose("map", "b", 0));
  EXPECT_TRUE(explains("the parents of frame b form a cycle")) << reason_;
  EXPECT_TRUE(explains("a -> b")) << reason_;
  EXPECT_TRUE(tree_.above("a").empty());
  EXPECT_TRUE(tree_.above("nowhere").empty());
  EXPECT_TRUE(tree_.above("map").empty());
}

TEST_F(TransformTreeTest, LooksUpQuicklyInLongRecordings) {
  for (int i = 0; i < 300000; ++i) dynamic("odom", "base", i, poseAt(0.001 * i));
  tree_.finish();
  Random random(1);
  const auto chain = tree_.chain("odom", "base", reason_);
  for (int i = 0; i < 300000; ++i) {
    const auto at = static_cast<std::int64_t>(random.below(299000000)) * 1000;
    PoseLookup lookup;
    const auto got = tree_.pose(*chain, nanoseconds(at), kLimits, lookup);
    ASSERT_NEAR(got.value().translation.x(), 1e-9 * static_cast<double>(at), 1e-9);
  }
}

TEST_F(TransformTreeTest, RefusesChainsThatOnlyHostileFilesHave) {
  for (int i = 0; i < 20000; ++i) fixed("f" + std::to_string(i), "f" + std::to_string(i + 1), Pose());
  tree_.finish();
  EXPECT_FALSE(pose("f0", "f20000", 0));
  EXPECT_TRUE(explains("a chain of more than 256 frames")) << reason_;
  EXPECT_TRUE(pose("f0", "f256", 0));
  EXPECT_LT(tree_.frames().size(), 200u);
}

}  // namespace
}  // namespace gaussmap::detail
