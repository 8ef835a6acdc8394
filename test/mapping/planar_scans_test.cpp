// SPDX-License-Identifier: BSD-3-Clause
// Planar maps of scans in space: the points lose z after the limits have been applied.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gaussmap/core/scans.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

using test::randomCloud;

Pose tiltedPose(double x, double yaw) {
  Pose pose;
  pose.translation = {x, 0.5, 1.2};
  pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  return pose;
}

MemoryScans scansInSpace() {
  MemoryScans scans;
  for (std::uint64_t i = 0; i < 6; ++i)
    scans.add({randomCloud<3>(40000, 300 + i), tiltedPose(double(i), 0.3 * double(i)), 0, std::nullopt});
  return scans;
}

void expectSameCells(const MomentGrid<2>& a, const MomentGrid<2>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const CellMoments<2>* const found = b.find(a[i].key);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(*found, a[i].moments);
  }
}

TEST(PlanarScans, AreThePointsInSpaceWithoutTheirHeight) {
  const MemoryScans scans = scansInSpace();
  AccumulateOptions options;
  options.resolution = 0.05;
  options.max_range = 3.0;
  options.crop = Box<3>{{-10, -10, 0.5}, {10, 10, 1.5}};
  const std::vector<Vector<3>> in_space = readPoints(scans, options);
  MomentGrid<2> expected(0.05);
  std::vector<Vector<2>> flat;
  for (const Vector<3>& point : in_space) {
    EXPECT_GE(point.z(), 0.5);
    EXPECT_LT(point.z(), 1.5);
    flat.push_back(point.head<2>());
  }
  expected.addPoints(flat);
  for (const int threads : {1, 2}) {
    options.threads = threads;
    const AccumulatedScans<2> all = accumulateScans<2>(scans, options);
    expectSameCells(all.moments, expected);
    const PointCounts counts = accumulateScans(scans, options).counts;
    EXPECT_EQ(all.counts.accepted, counts.accepted);
    EXPECT_EQ(all.counts.outside, counts.outside);
    EXPECT_GT(counts.outside, 0);
    EXPECT_EQ(all.moments.pointCount(), counts.accepted);
  }
  EXPECT_EQ(readPoints<2>(scans, options), flat);
}

TEST(PlanarScans, InPartsGiveTheSameSums) {
  const MemoryScans scans = scansInSpace();
  AccumulateOptions options;
  options.resolution = 0.01;
  const AccumulatedScans<2> whole = accumulateScans<2>(scans, options);
  std::size_t parts = 0;
  MomentGrid<2> sum(0.01);
  const PointCounts counts = accumulateScansInParts<2>(scans, options, 1 << 20, [&](const MomentGrid<2>& part) {
    ++parts;
    sum.merge(part);
  });
  EXPECT_GT(parts, 2u);
  EXPECT_EQ(counts.accepted, whole.counts.accepted);
  expectSameCells(sum, whole.moments);
}

/// The distance of a point from the nearest wall of a room of 6 x 4 m.
double fromWalls(double x, double y) {
  return std::min({std::abs(x), std::abs(x - 6.0), std::abs(y), std::abs(y - 4.0)});
}

/// The mean distance from the walls of samples near them [m], of one scale. In space, only samples in the slice count.
template <int D>
double errorAtWalls(const GaussianMap<D>& map, int scale) {
  SampleOptions sampling;
  sampling.samples = D == 2 ? 20000 : 200000;
  double sum = 0.0;
  std::size_t count = 0;
  for (const Vector<D>& point : sampleMap<D>(map, scale, sampling).points) {
    if constexpr (D == 3)
      if (point.z() < 1.0 || point.z() >= 1.5) continue;
    const double error = fromWalls(point.x(), point.y());
    if (error > 0.5) continue;
    sum += error;
    ++count;
  }
  EXPECT_GT(count, 5000u);
  return sum / static_cast<double>(count);
}

TEST(PlanarScans, OfASliceMapTheWallsAsWellAsTheMapInSpace) {
  MemoryScans scans;
  Random random(4);
  for (int scan = 0; scan < 4; ++scan) {
    const Pose pose = tiltedPose(1.0 + scan, 0.4 * scan);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 20000; ++i) {  // four walls, 2.5 m high, and the floor, with a noise of 1 cm
      const double x = 6.0 * random.uniform(), y = 4.0 * random.uniform(), z = 2.5 * random.uniform();
      const double noise = 0.01 * random.normal();
      const Eigen::Vector3d in_map[5] = {
          {x, noise, z}, {x, 4.0 + noise, z}, {noise, y, z}, {6.0 + noise, y, z}, {x, y, noise}};
      points.push_back(pose.inverse() * in_map[random.below(5)]);
    }
    scans.add({points, pose, 0, std::nullopt});
  }
  const MapOptions options{0.1, 5, 3, 0.0};
  AccumulateOptions slice;
  slice.crop = Box<3>{{-1, -1, 1.0}, {7, 5, 1.5}};
  const GaussianMap<2> plane = refine<2>(build<2>(scans, options, slice)).map;
  const GaussianMap<3> space = refine<3>(build<3>(scans, options)).map;
  for (int scale = 0; scale < 3; ++scale)
    EXPECT_LT(errorAtWalls(plane, scale), 1.1 * errorAtWalls(space, scale)) << scale;
}

TEST(PlanarScans, MakeTheMapOfTheirPoints) {
  const MemoryScans scans = scansInSpace();
  const MapOptions options{0.05, 4, 3, 0.0};
  PointCounts counts;
  const GaussianMap<2> map = build<2>(scans, options, {}, &counts),
                       expected = build<2>(readPoints<2>(scans, {}), options);
  EXPECT_EQ(counts.accepted, 240000);
  for (int s = 0; s < 3; ++s) EXPECT_EQ(map.scale(s).keys, expected.scale(s).keys);
  EXPECT_EQ(map.scale(0).moments, expected.scale(0).moments);
}

}  // namespace
}  // namespace gaussmap
