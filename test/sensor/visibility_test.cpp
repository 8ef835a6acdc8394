// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/sensor/visibility.h"

#include <gtest/gtest.h>

#include <limits>

#include "sensor/views.h"

namespace gaussmap {
namespace {

using Eigen::Vector3d;
using test::camera;
using test::imageOf;
using test::kDegree;
using test::lidar;

std::string nameOf(Visibility visibility) {
  const char* const names[] = {"OutOfView", "NoEvidence", "Hidden", "AtSurface", "PassedThrough"};
  return names[static_cast<std::size_t>(visibility)];
}
#define EXPECT_VISIBILITY(expression, expected) EXPECT_EQ(nameOf(expression), nameOf(Visibility::expected))

/// A wall at x = `distance`, seen from before it.
auto wallAt(double distance) {
  return [=](const Vector3d& direction) -> std::optional<double> {
    if (!(direction.x() > 0.05)) return std::nullopt;
    return distance / direction.x();
  };
}

TEST(VisibilityOf, TellsBeforeAWallFromInAndBehindIt) {
  const RangeImage spherical = imageOf(lidar(41, -20.5, 20.5, 361), wallAt(10.0));
  const PlanarProjection sees_x{300, 300, 20, 20, 41, 41};
  const RangeImage planar = imageOf(sees_x, [](const Vector3d& d) { return 10.0 / d.z(); });
  for (const double sideways : {-2.0, 0.0, 0.3}) {
    const auto in = [&](const RangeImage& image, double distance) {
      return &image == &planar ? visibilityOf(image, {0.01 * sideways, 0.02, distance}, {0.3, 0.35, DepthNoise()})
                               : visibilityOf(image, {distance, sideways, 0.4});
    };
    for (const RangeImage* image : {&spherical, &planar}) {
      EXPECT_VISIBILITY(in(*image, 2.0), PassedThrough);
      EXPECT_VISIBILITY(in(*image, 9.0), PassedThrough);
      EXPECT_VISIBILITY(in(*image, 9.6), PassedThrough);
      EXPECT_VISIBILITY(in(*image, 9.67), AtSurface);  // a beam ends .33 behind it, but the wall is nearer than .35
      EXPECT_VISIBILITY(in(*image, 9.8), AtSurface);
      EXPECT_VISIBILITY(in(*image, 10.0), AtSurface);
      EXPECT_VISIBILITY(in(*image, 10.2), AtSurface);
      EXPECT_VISIBILITY(in(*image, 10.5), Hidden);
      EXPECT_VISIBILITY(in(*image, 1e6), Hidden);
    }
  }
}

TEST(VisibilityOf, CountsABeamOnlyBeyondTheNoiseOfItsDepth) {
  // A Kinect at 8 m and 7.5 m: 0.0012 + 0.0019 * 7.6^2 = 0.1109 m and 0.0012 + 0.0019 * 7.1^2 = 0.0970 m. Three of each
  // are 0.624 m, so a beam that ends at 8 m frees no point beyond 8 - 0.924 = 7.08 m or so (the noise is less there).
  const PlanarProjection sees{300, 300, 20, 20, 41, 41};
  const RangeImage image = imageOf(sees, [](const Vector3d& d) { return 8.0 / d.z(); });
  EXPECT_VISIBILITY(visibilityOf(image, {0, 0, 7.5}), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, {0, 0, 7.15}), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, {0, 0, 7.0}), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(image, {0, 0, 7.5}, {0.3, 0.35, DepthNoise()}), PassedThrough);
  // A near wall: the noise is small, so the limits are nearly those of a lidar.
  const RangeImage near = imageOf(sees, [](const Vector3d& d) { return 2.0 / d.z(); });
  EXPECT_VISIBILITY(visibilityOf(near, {0, 0, 1.6}), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(near, {0, 0, 1.7}), AtSurface);
}

TEST(VisibilityOf, TakesTheNoiseThatIsStatedForALidarToo) {
  const RangeImage image = imageOf(lidar(3, -3, 3, 361), [](const Vector3d&) { return 10.0; });
  EXPECT_VISIBILITY(visibilityOf(image, {9.5, 0, 0}), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(image, {9.5, 0, 0}, {0.3, 0.35, DepthNoise{0.05, 0.0, 0.0}}), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, {9.3, 0, 0}, {0.3, 0.35, DepthNoise{0.05, 0.0, 0.0}}), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(image, {5.0, 0, 0}, {0.3, 0.35, DepthNoise{0.0, 0.02, 0.0}}), AtSurface);
}

TEST(VisibilityOf, TestsThePixelsOfACameraThreeCentimetresBesideThePoint) {
  // The edge of a board at z = 1 covers columns from 70 on; the wall behind it is at 3 m. A point on the edge that
  // projects 12 pixels beside it, by a pose error of 2 cm, is not free: 500 pixel * 3 cm / 1 m = 15 pixels.
  const PlanarProjection sees{500, 500, 64, 64, 129, 129};
  const RangeImage image = imageOf(sees, [](const Vector3d& d) { return (d.x() / d.z() > 0.012 ? 1.0 : 3.0) / d.z(); });
  EXPECT_VISIBILITY(visibilityOf(image, {-0.012, 0, 1.0}), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, {-0.06, 0, 1.0}), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(image, {-0.012, 0, 1.0}, {0.3, 0.35, std::nullopt, 0.001}), PassedThrough);
}

TEST(DepthNoiseAt, GrowsWithTheSquareOfTheDepthBeyondItsStart) {
  EXPECT_DOUBLE_EQ(DepthNoise::camera().at(0.2), 0.0012);
  EXPECT_NEAR(DepthNoise::camera().at(5.0), 0.0012 + 0.0019 * 4.6 * 4.6, 1e-15);
  EXPECT_EQ(DepthNoise().at(100.0), 0.0);
}

TEST(VisibilityOf, KeepsToTheToleranceToTheLastBit) {
  const RangeImage image = imageOf(lidar(3, -3, 3, 361), [](const Vector3d&) { return 10.0; });
  const auto at = [&](double range) { return visibilityOf(image, {range, 0, 0}, {0.25, 0.0}); };
  EXPECT_VISIBILITY(at(std::nextafter(9.75, 0.0)), PassedThrough);
  EXPECT_VISIBILITY(at(9.75), AtSurface);
  EXPECT_VISIBILITY(at(10.25), AtSurface);
  EXPECT_VISIBILITY(at(std::nextafter(10.25, 11.0)), Hidden);
  EXPECT_VISIBILITY(visibilityOf(image, {9.7, 0, 0}, {0.25, 0.301}), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, {9.7, 0, 0}, {0.25, 0.299}), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(image, {10, 0, 0}, {0.0, 0.0}), AtSurface);
}

TEST(VisibilityOf, SeesNothingOutOfView) {
  const RangeImage image = imageOf(lidar(3, -3, 3, 360), [](const Vector3d&) { return 10.0; });
  EXPECT_VISIBILITY(visibilityOf(image, {1, 0, 1}), OutOfView);
  EXPECT_VISIBILITY(visibilityOf(image, {0, 0, 0}), OutOfView);
  EXPECT_VISIBILITY(visibilityOf(image, {std::numeric_limits<double>::quiet_NaN(), 0, 0}), OutOfView);
  EXPECT_VISIBILITY(visibilityOf(imageOf(camera(), [](const Vector3d&) { return 10.0; }), {0, 0, -1}), OutOfView);
}

TEST(VisibilityOf, KeepsARoadThatBeamsMeetFarBehindThePoint) {
  // From 1.8 m above it, rows of 2 degrees, the lowest from -4 to -2: its beam meets the road at 34.3 m.
  const RangeImage image = imageOf(lidar(7, -4, 10, 360), [](const Vector3d& direction) -> std::optional<double> {
    return direction.z() < 0.0 ? 1.8 / -direction.z() : 80.0;
  });
  const Vector3d on_road(26.4, 0.05, -1.8);
  EXPECT_GT(image.at(0, 180).nearest, on_road.norm() + 7.0);
  EXPECT_VISIBILITY(visibilityOf(image, on_road), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, on_road + Vector3d(0, 0, 0.3)), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, on_road + Vector3d(0, 0, 0.4)), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(image, on_road + Vector3d(0, 0, 1.5)), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(image, on_road, {0.3, 0.0}), PassedThrough);  // that rule alone keeps it
}

TEST(VisibilityOf, KeepsACeilingToo) {  // the same upside down
  const RangeImage image = imageOf(lidar(7, -10, 4, 360), [](const Vector3d& direction) -> std::optional<double> {
    return direction.z() > 0.0 ? 1.8 / direction.z() : 80.0;
  });
  const Vector3d on_ceiling(26.4, 0.05, 1.8);
  EXPECT_VISIBILITY(visibilityOf(image, on_ceiling), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, on_ceiling - Vector3d(0, 0, 0.3)), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(image, on_ceiling - Vector3d(0, 0, 0.4)), PassedThrough);
}

TEST(VisibilityOf, KeepsWhatStandsBesideFreeBeams) {  // a pole in column 180, seen one degree wide
  const RangeImage image = imageOf(lidar(9, -9, 9, 360), [](const Vector3d& direction) {
    const double azimuth = std::atan2(direction.y(), direction.x()) / kDegree;
    return azimuth > 0.0 && azimuth < 1.0 ? 10.0 : 30.0;
  });
  const auto at = [&](double range, double azimuth_deg) {
    return visibilityOf(image, range * Vector3d(std::cos(azimuth_deg * kDegree), std::sin(azimuth_deg * kDegree), 0.0));
  };
  for (const double azimuth : {-0.5, 0.5, 1.5}) {
    EXPECT_VISIBILITY(at(9.0, azimuth), PassedThrough);
    EXPECT_VISIBILITY(at(10.0, azimuth), AtSurface);
    EXPECT_VISIBILITY(at(12.0, azimuth), Hidden);
  }
  for (const double azimuth : {-1.5, 2.5}) {
    EXPECT_VISIBILITY(at(10.0, azimuth), PassedThrough);
    EXPECT_VISIBILITY(at(12.0, azimuth), PassedThrough);
  }
}

TEST(VisibilityOf, AsksForReturnsInHalfOfThePixelsAround) {
  const Projection projection = lidar(3, -3, 3, 360);
  RangeImage image(projection);
  int filled = 0;
  for (int row = 0; row < 3; ++row)
    for (const int column : {180, 179, 181}) {
      const Visibility expected = filled >= 5 ? Visibility::PassedThrough : Visibility::NoEvidence;
      EXPECT_EQ(nameOf(visibilityOf(image, 5.0 * directionOf(projection, {1, 180}))), nameOf(expected)) << filled;
      image.add(20.0 * directionOf(projection, {row, column}));
      ++filled;
    }
  // In the lowest row only six pixels are around.
  EXPECT_VISIBILITY(visibilityOf(image, 5.0 * directionOf(projection, {0, 180})), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(image, 5.0 * directionOf(projection, {0, 181})), NoEvidence);
  EXPECT_VISIBILITY(visibilityOf(image, 50.0 * directionOf(projection, {0, 181})), NoEvidence);
}

TEST(VisibilityOf, TakesTheNeighboursInTheRowIfThereIsOne) {
  const Projection projection = lidar(1, -1, 1, 360);
  RangeImage image(projection);
  const Vector3d point = 5.0 * directionOf(projection, {0, 180});
  EXPECT_VISIBILITY(visibilityOf(image, point), NoEvidence);
  image.add(20.0 * directionOf(projection, {0, 180}));
  EXPECT_VISIBILITY(visibilityOf(image, point), NoEvidence);
  image.add(20.0 * directionOf(projection, {0, 181}));
  EXPECT_VISIBILITY(visibilityOf(image, point), PassedThrough);
  image.add(4.0 * directionOf(projection, {0, 179}));
  EXPECT_VISIBILITY(visibilityOf(image, point), Hidden);
}

TEST(VisibilityOf, KeepsAWallAlongTheBeamsOfAPlanarLaser) {
  // A wall at y = 1, of which two beams came back, from behind the point.
  const Projection projection = lidar(1, -1, 1, 360);
  RangeImage wall(projection);
  wall.add(directionOf(projection, {0, 183}) / directionOf(projection, {0, 183}).y());  // 16.4 m away
  wall.add(directionOf(projection, {0, 182}) / directionOf(projection, {0, 182}).y());  // 22.9 m
  EXPECT_VISIBILITY(visibilityOf(wall, Vector3d(14.5, 1.0, 0.0)), AtSurface);
  EXPECT_VISIBILITY(visibilityOf(wall, Vector3d(14.5, 1.0, 0.0), {0.3, 0.0}), PassedThrough);
  EXPECT_VISIBILITY(visibilityOf(wall, Vector3d(9.4, 0.6, 0.0)), PassedThrough);
}

TEST(VisibilityOf, AnswersTheSameOnBothSidesOfTheCut) {  // the scene turned by any number of columns
  constexpr int kColumns = 36;
  const Projection projection = lidar(5, -25, 25, kColumns);
  Random random(4);
  std::vector<double> ranges(5 * kColumns);
  for (double& range : ranges) range = random.below(6) == 0 ? 0.0 : 5.0 + 10.0 * random.uniform();
  const auto turned = [&](int by) {
    RangeImage image(projection);
    for (int row = 0; row < 5; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const double range = ranges[static_cast<std::size_t>(row * kColumns + column)];
        if (range > 0.0) image.add(range * directionOf(projection, {row, (column + by) % kColumns}));
      }
    return image;
  };
  const RangeImage still = turned(0);
  int passed = 0;
  for (int by = 1; by < kColumns; ++by) {
    const RangeImage image = turned(by);
    for (int row = 0; row < 5; ++row)
      for (int column = 0; column < kColumns; ++column)
        for (const double range : {3.0, 5.5, 8.0}) {
          const Visibility before = visibilityOf(still, range * directionOf(projection, {row, column}));
          const Visibility after =
              visibilityOf(image, range * directionOf(projection, {row, (column + by) % kColumns}));
          ASSERT_EQ(nameOf(after), nameOf(before)) << "row " << row << " column " << column << " turned by " << by;
          passed += before == Visibility::PassedThrough;
        }
  }
  EXPECT_GT(passed, 1000);
}

TEST(VisibilityOf, AnswersInImagesOfAFewPixels) {
  for (const Projection& projection :
       {Projection(lidar(1, -90, 91, 1)), Projection(lidar(2, -90, 91, 1)), Projection(lidar(1, -90, 91, 2)),
        Projection(PlanarProjection{1, 1, 0, 0, 1, 1})}) {
    const RangeImage image = imageOf(projection, [](const Vector3d&) { return 10.0; });
    Random random(9);
    for (int i = 0; i < 100; ++i) {
      const Vector3d direction = test::randomDirection(random);
      EXPECT_NE(nameOf(visibilityOf(image, direction)), "Hidden");
      EXPECT_NE(nameOf(visibilityOf(image, 20.0 * direction)), "PassedThrough");
    }
  }
}

TEST(Evidences, KnowTheFirstAndTheLastHitInAnyOrder) {
  Evidence evidence;
  evidence.miss();
  for (const std::uint32_t scan : {7u, 3u, 12u, 5u}) evidence.hit(scan);
  evidence.miss();
  EXPECT_EQ(evidence.hits, 4u);
  EXPECT_EQ(evidence.misses, 2u);
  EXPECT_EQ(evidence.first_hit, 3u);
  EXPECT_EQ(evidence.last_hit, 12u);
}

TEST(Evidences, AddUpToLogOdds) {
  EXPECT_EQ(logOdds(Evidence{}), 0.0);
  EXPECT_DOUBLE_EQ(logOdds(Evidence{4, 2, 3, 12}), 4 * 0.85 - 2 * 0.4);
  EXPECT_DOUBLE_EQ(logOdds(Evidence{1, 3, 0, 0}, OccupancyOptions{2.0, 0.5, 10.0}), 0.5);
  EXPECT_LT(logOdds(Evidence{0, 4000000000u, 0, 0}), -1e9);  // no bounds
}

TEST(Evidences, KeepWhatIsHitInThirtyTwoOfAHundredViews) {
  EXPECT_GT(logOdds(Evidence{33, 67, 0, 0}), 0.0);
  EXPECT_LT(logOdds(Evidence{31, 69, 0, 0}), 0.0);
}

}  // namespace
}  // namespace gaussmap
