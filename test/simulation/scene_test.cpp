// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaussmap/core/gaussian.h"
#include "simulation/lidar.h"

namespace gaussmap {
namespace {

const Rectangle kDoor{{2, 0, 0}, {0, 1, 0}, {0, 0, 2}};  // in the plane x = 2, y in [0, 1], z in [0, 2]
const Cylinder kPost{{0, 0, 0}, {0, 0, 3}, 0.5};

Ray towards(const Eigen::Vector3d& origin, const Eigen::Vector3d& target) {
  return {origin, (target - origin).normalized()};
}

Eigen::Vector3d at(const Ray& ray, double range) {
  return ray.origin + range * ray.direction;
}

Eigen::Vector3d onMap(const SimulatedScan& scan, std::size_t i) {
  return scan.pose.rotation * scan.points[i] + scan.pose.translation;
}

TEST(RayAndRectangle, MeetInsideAndMissOutside) {
  EXPECT_EQ(intersect({{0, 0.5, 1}, {1, 0, 0}}, kDoor), 2.0);
  EXPECT_EQ(intersect({{3, 0.5, 1}, {-1, 0, 0}}, kDoor), 1.0);  // from behind
  EXPECT_FALSE(intersect({{0, 0.5, 1}, {-1, 0, 0}}, kDoor));    // the other way
  EXPECT_FALSE(intersect({{0, 1.01, 1}, {1, 0, 0}}, kDoor));
  EXPECT_FALSE(intersect({{0, -0.01, 1}, {1, 0, 0}}, kDoor));
  EXPECT_FALSE(intersect({{0, 0.5, 2.01}, {1, 0, 0}}, kDoor));
  EXPECT_FALSE(intersect({{2, 0.5, -1}, {0, 0, 1}}, kDoor));  // within its plane
  EXPECT_NEAR(*intersect(towards({0, 0, 0}, {2, 1, 2}), kDoor), 3.0, 1e-12);
}

TEST(RayAndCylinder, MeetAtTheNearSideAndFromWithinAtTheFarSide) {
  EXPECT_DOUBLE_EQ(*intersect({{-3, 0, 1}, {1, 0, 0}}, kPost), 2.5);
  EXPECT_DOUBLE_EQ(*intersect({{0, 0, 1}, {1, 0, 0}}, kPost), 0.5);
  EXPECT_DOUBLE_EQ(*intersect({{-3, 0.3, 1}, {1, 0, 0}}, kPost), 2.6);  // half chord 0.4
  EXPECT_FALSE(intersect({{-3, 0.51, 1}, {1, 0, 0}}, kPost));
  EXPECT_FALSE(intersect({{-3, 0, 3.01}, {1, 0, 0}}, kPost));
  EXPECT_FALSE(intersect({{3, 0, 1}, {1, 0, 0}}, kPost));   // behind
  EXPECT_FALSE(intersect({{0, 0, -1}, {0, 0, 1}}, kPost));  // through the open ends
}

TEST(RayAndCylinder, MeetInsideThroughTheOpenEnd) {
  const Ray ray = towards({-0.9, 0, 3.8}, {0.5, 0, 2.4});  // down at 45 degrees, 0.4 m above the near rim
  EXPECT_NEAR(*intersect(ray, kPost), 1.4 * std::sqrt(2.0), 1e-12);
}

TEST(Distance, ToARectangleIsToItsFaceEdgeOrCorner) {
  EXPECT_DOUBLE_EQ(distance({5, 0.5, 1}, kDoor), 3.0);
  EXPECT_DOUBLE_EQ(distance({2, 0.5, 1}, kDoor), 0.0);
  EXPECT_DOUBLE_EQ(distance({5, 5, 1}, kDoor), 5.0);  // 3 off the plane, 4 off the edge
  EXPECT_DOUBLE_EQ(distance({3, 3, 4}, kDoor), 3.0);  // corner (2, 1, 2)
  EXPECT_DOUBLE_EQ(distance({2, -1, -1}, kDoor), std::sqrt(2.0));
}

TEST(Distance, ToACylinderIsToItsSideOrRim) {
  EXPECT_DOUBLE_EQ(distance({3, 0, 1}, kPost), 2.5);
  EXPECT_DOUBLE_EQ(distance({0, 0, 1}, kPost), 0.5);  // on the axis
  EXPECT_DOUBLE_EQ(distance({0.3, 0.4, 2}, kPost), 0.0);
  EXPECT_DOUBLE_EQ(distance({3.5, 0, 7}, kPost), 5.0);   // 3 off the side, 4 above the rim
  EXPECT_DOUBLE_EQ(distance({0, 0, -1.2}, kPost), 1.3);  // 1.2 below, 0.5 to the rim
}

TEST(Distance, OfASceneIsToTheNearestSurfaceAndOfNoneInfinite) {
  const Scene scene{{kDoor}, {kPost}};
  EXPECT_DOUBLE_EQ(scene.distance({1, 0.5, 1}), std::sqrt(1.25) - 0.5);
  EXPECT_NEAR(scene.distance({1.9, 0.5, 1}), 0.1, 1e-15);
  EXPECT_EQ(Scene().distance({0, 0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(Scene().intersect({{0, 0, 0}, {1, 0, 0}}));
}

TEST(Scene, GivesTheNearestHitAndItIsOnASurface) {
  const Scene scene{{kDoor}, {kPost}};
  EXPECT_DOUBLE_EQ(*scene.intersect({{-3, 0.3, 1}, {1, 0, 0}}), 2.6);  // the post hides the door
  Random random(1);
  const Scene demo = demoScene();
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d origin(random.normal(), random.normal(), 1.0 + random.uniform());
    const Ray ray{origin, GaussianSampler<3>::standard(random).normalized()};
    const std::optional<double> range = demo.intersect(ray);
    if (!range) continue;
    ++hits;
    ASSERT_LT(demo.distance(at(ray, *range)), 1e-9);
    for (const double part : {0.1, 0.5, 0.9}) {  // nothing nearer: no surface can be closer than it is along the ray
      const double gap = demo.distance(at(ray, part * *range));
      ASSERT_LE(gap, (1.0 - part) * *range + 1e-9);
      ASSERT_GT(gap, 0.0);
    }
  }
  EXPECT_GT(hits, 8000);
}

TEST(Scene, MovedAsAWholeKeepsItsDistances) {
  const Scene scene{{kDoor}, {kPost}};
  const Pose pose{{4, -5, 6}, Pose::Rotation(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()))};
  const Scene moved = scene.transformed(pose);
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d point = 3.0 * GaussianSampler<3>::standard(random);
    EXPECT_NEAR(moved.distance(pose.rotation * point + pose.translation), scene.distance(point), 1e-12);
  }
}

TEST(Scene, RefusesPrimitivesThatAreNone) {
  EXPECT_NO_THROW(checkScene(demoScene()));
  EXPECT_THROW(checkScene({{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}, {}}), std::invalid_argument);
  EXPECT_THROW(checkScene({{{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}}, {}}), std::invalid_argument);
  EXPECT_THROW(checkScene({{}, {{{0, 0, 0}, {0, 0, 1}, 0.0}}}), std::invalid_argument);
  EXPECT_THROW(checkScene({{}, {{{0, std::nan(""), 0}, {0, 0, 1}, 1.0}}}), std::invalid_argument);
}

TEST(SampleSurface, CoversTheSurfacesEvenlyAndStaysOnThem) {
  const Scene scene{{kDoor}, {kPost}};
  const std::vector<Eigen::Vector3d> points = sampleSurface(scene, 0.1);
  EXPECT_EQ(points.size(), 10u * 20u + 32u * 30u);  // 2 pi 0.5 / 0.1 = 31.4 tiles around
  for (const Eigen::Vector3d& point : points) ASSERT_LT(scene.distance(point), 1e-12);
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d on_door = kDoor.corner + random.uniform() * kDoor.u + random.uniform() * kDoor.v;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& point : points) nearest = std::min(nearest, (point - on_door).norm());
    EXPECT_LT(nearest, 0.1 / std::sqrt(2.0) + 1e-12);
  }
}

TEST(SampleSurface, RefusesSpacingsThatMakeNoSense) {
  EXPECT_THROW(sampleSurface(demoScene(), 0.0), std::invalid_argument);
  EXPECT_THROW(sampleSurface(demoScene(), -1.0), std::invalid_argument);
  EXPECT_THROW(sampleSurface(demoScene(), std::nan("")), std::invalid_argument);
  EXPECT_THROW(sampleSurface(demoScene(), 1e-6), std::invalid_argument);
  EXPECT_TRUE(sampleSurface(Scene(), 0.1).empty());
}

TEST(SimulatedScan, WithoutNoiseLiesOnTheScene) {
  const Scene scene = demoScene();
  LidarOptions options;
  options.noise = 0.0;
  for (const Pose& pose : demoTrajectory()) {
    const SimulatedScan scan = simulateScan(scene, pose, options);
    ASSERT_EQ(scan.points.size(), scan.truth.size());
    EXPECT_GT(scan.points.size(), 15000u);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      ASSERT_LT(scene.distance(onMap(scan, i)), 1e-9);
      ASSERT_LT((onMap(scan, i) - scan.truth[i]).norm(), 1e-9);
    }
  }
}

TEST(SimulatedScan, HasNormalNoiseAlongItsRays) {
  LidarOptions options;
  options.noise = 0.02;
  const Pose pose = demoTrajectory().front();
  const SimulatedScan scan = simulateScan(demoScene(), pose, options);
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const double range = (scan.truth[i] - pose.translation).norm(), noise = scan.points[i].norm() - range;
    ASSERT_LT((onMap(scan, i) - scan.truth[i]).norm() - std::abs(noise), 1e-9);  // along the ray only
    sum += noise;
    squares += noise * noise;
  }
  const auto count = static_cast<double>(scan.points.size());
  EXPECT_NEAR(sum / count, 0.0, 5 * 0.02 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.0005);
}

TEST(SimulatedScan, ArrivesColumnByColumnAndRingByRing) {
  // In the middle of a vertical tube every ray comes back: rings at -10, 0, 10 degrees, 4 columns a right angle apart.
  const Scene tube{{}, {{{0, 0, -5}, {0, 0, 10}, 2.0}}};
  LidarOptions options;
  options.rings = 3;
  options.lowest_deg = -10;
  options.highest_deg = 10;
  options.columns = 4;
  options.noise = 0.0;
  const SimulatedScan scan = simulateScan(tube, Pose(), options);
  ASSERT_EQ(scan.points.size(), 12u);
  const double height = 2.0 * std::tan(10.0 * std::acos(-1.0) / 180.0);
  const Eigen::Vector3d across[] = {{2, 0, 0}, {0, 2, 0}, {-2, 0, 0}, {0, -2, 0}};
  for (std::size_t i = 0; i < 12; ++i) {
    const Eigen::Vector3d expected = across[i / 3] + Eigen::Vector3d(0, 0, (double(i % 3) - 1.0) * height);
    EXPECT_LT((scan.points[i] - expected).norm(), 1e-12) << i;
  }
}

TEST(SimulatedScan, LeavesOutWhatIsOutOfRange) {
  const Scene wall{{{{10, -50, -50}, {0, 100, 0}, {0, 0, 100}}}, {}};
  LidarOptions options;
  options.rings = 1;
  options.lowest_deg = options.highest_deg = 0.0;
  options.columns = 360;
  options.noise = 0.0;
  options.max_range = 20.0;  // cos 60 = 10 / 20: azimuths -60 ... 60, of which the two last are on the limit
  const std::size_t returns = simulateScan(wall, Pose(), options).points.size();
  EXPECT_GE(returns, 119u);
  EXPECT_LE(returns, 121u);
  options.max_range = 9.9;
  EXPECT_TRUE(simulateScan(wall, Pose(), options).points.empty());
}

TEST(SimulatedScan, IsTheSameForTheSameSeedWithAnyNumberOfThreads) {
  LidarOptions options;
  options.threads = 1;
  const Pose pose = demoTrajectory()[2];
  const SimulatedScan one = simulateScan(demoScene(), pose, options, 7);
  options.threads = 2;
  EXPECT_EQ(one.points, simulateScan(demoScene(), pose, options, 7).points);
  EXPECT_NE(one.points, simulateScan(demoScene(), pose, options, 8).points);
}

TEST(SimulatedScan, RefusesOptionsAndPosesThatCannotBe) {
  const auto refused = [](auto change) {
    LidarOptions options;
    change(options);
    EXPECT_THROW(simulateScan(Scene(), Pose(), options), std::invalid_argument);
  };
  refused([](LidarOptions& options) { options.rings = 0; });
  refused([](LidarOptions& options) { options.columns = -1; });
  refused([](LidarOptions& options) { options.noise = -0.1; });
  refused([](LidarOptions& options) { options.max_range = 0.0; });
  refused([](LidarOptions& options) { options.highest_deg = 90.0; });
  refused([](LidarOptions& options) { options.lowest_deg = 20.0; });
  Pose tilted;
  tilted.rotation.coeffs() *= 2.0;
  EXPECT_THROW(simulateScan(Scene(), tilted), std::invalid_argument);
}

TEST(DemoScene, IsSeenAllOverByItsTrajectory) {
  const Scene scene = demoScene();
  std::vector<std::size_t> seen(4, 0);  // floor, long wall, short wall, pole
  for (const Pose& pose : demoTrajectory()) {
    EXPECT_TRUE(poseFault(pose).empty());
    EXPECT_GT(scene.distance(pose.translation), 1.0);
    for (const Eigen::Vector3d& point : simulateScan(scene, pose).truth) {
      for (std::size_t i = 0; i < 3; ++i) seen[i] += distance(point, scene.rectangles[i]) < 1e-9;
      seen[3] += distance(point, scene.cylinders[0]) < 1e-9;
    }
  }
  EXPECT_GT(seen[0], 50000u);
  EXPECT_GT(seen[1], 20000u);
  EXPECT_GT(seen[2], 10000u);
  EXPECT_GT(seen[3], 500u);
}

}  // namespace
}  // namespace gaussmap
