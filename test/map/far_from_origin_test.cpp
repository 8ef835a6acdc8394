// SPDX-License-Identifier: BSD-3-Clause
// 5,000 km from the origin a map is the map at the origin, shifted.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/mapping/refine.h"
#include "io/files/temporary_directory.h"
#include "io/gmap/map_equality.h"
#include "map/random_clouds.h"
#include "mapping/online/online_scenes.h"

namespace gaussmap::test {
namespace {

/// Whole cells of every scale: the coarsest have 12.5 m.
const MapOptions kOptions{0.125, 10, 3, 0.0};
const Vector<3> kShift(5e6, -5e6, 5e6);

/// Expects bit-identical maps, except for the keys, which differ by the shift.
void expectShifted(const GaussianMapOctree& here, const GaussianMapOctree& there) {
  for (int s = 0; s < here.scales(); ++s) {
    SCOPED_TRACE(s);
    const MapScale<3>&a = here.scale(s), &b = there.scale(s);
    CellKey<3> shift;
    for (std::size_t axis = 0; axis < 3; ++axis)
      shift[axis] = static_cast<std::int32_t>(kShift(static_cast<int>(axis)) / here.grid().side(s));
    ASSERT_EQ(a.keys.size(), b.keys.size());
    for (std::size_t i = 0; i < a.keys.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_EQ(a.keys[i][axis] + shift[axis], b.keys[i][axis]);
    EXPECT_TRUE(a.moments == b.moments);
    EXPECT_EQ(a.first_child, b.first_child);
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.log_odds, b.log_odds);
    ASSERT_EQ(a.gaussians.size(), b.gaussians.size());
    for (std::size_t i = 0; i < a.gaussians.size(); ++i) ASSERT_TRUE(sameGaussian<3>(a.gaussians[i], b.gaussians[i]));
    EXPECT_TRUE(sameRanges<3>(here, there, s));
  }
}

/// A cloud whose points survive the shift.
std::vector<Vector<3>> latticeCloud(std::size_t count, std::uint64_t seed) {
  std::vector<Vector<3>> points = randomCloud<3>(count, seed);
  for (Vector<3>& point : points)
    for (int axis = 0; axis < 3; ++axis) point(axis) = std::round(point(axis) * 4096.0) / 4096.0;
  return points;
}

TEST(FarFromTheOrigin, AMapOfScansIsTheSameThroughAllOfItsLife) {
  const TemporaryDirectory directory;
  std::vector<FileScan> near, far;
  for (std::uint64_t i = 0; i < 3; ++i) {
    const auto path = directory.path() / ("scan" + std::to_string(i) + ".pcd");
    writePcd(path, latticeCloud(4000, 81 + i), PcdPrecision::Float);
    Pose pose;
    pose.translation = {0.25 * static_cast<double>(i), -0.5, 0.125};
    near.push_back({path, pose});
    pose.translation += kShift;
    far.push_back({path, pose});
  }
  AccumulateOptions reading;
  reading.resolution = kOptions.resolution;
  const auto mapOf = [&](const std::vector<FileScan>& scans) {
    return build<3>(accumulateScans(FileScans(scans), reading).moments, kOptions);
  };
  GaussianMapOctree here = mapOf(near), there = mapOf(far);
  expectShifted(here, there);
  // By agglomeration: RefineMethod::Insert draws its random numbers by cell, and so by place.
  here = refine<3>(here, PerCell{2.5}).map;
  there = refine<3>(there, PerCell{2.5}).map;
  ASSERT_GT(here.gaussianCount(1), 2 * here.cellCount(1));
  expectShifted(here, there);
  for (const Precision precision : {Precision::Exact, Precision::Finished}) {
    SaveOptions saving;
    saving.overwrite = true;
    saving.precision = precision;
    save(directory.path() / "here.gmap", here, {}, saving);
    save(directory.path() / "there.gmap", there, {}, saving);
    expectShifted(load(directory.path() / "here.gmap"), load(directory.path() / "there.gmap"));
  }
}

TEST(FarFromTheOrigin, AMapOnLineIsTheSame) {
  OnlineOptions options = wallOptions();
  options.map = kOptions;
  options.look_back = 3;
  options.refine_every = 2;
  OnlineMapper<3> here(options), there(options);
  for (int i = 0; i < 6; ++i) {
    Scan scan = wallScan(i % 2 == 0);
    for (Eigen::Vector3d& point : scan.points)
      for (int axis = 0; axis < 3; ++axis) point(axis) = std::round(point(axis) * 4096.0) / 4096.0;
    here.add(scan);
    scan.pose.translation += kShift;
    there.add(scan);
  }
  expectShifted(here.map(), there.map());
}

TEST(FarFromTheOrigin, InCellsOfTenCentimetresNothingMovesMoreThanAMicrometre) {  // 0.1 is no binary number
  std::vector<Vector<3>> points = latticeCloud(5000, 91), far;
  for (const Vector<3>& point : points) far.push_back(point + kShift);
  const GaussianMapOctree here = build<3>(points, MapOptions()), there = build<3>(far, MapOptions());
  ASSERT_GT(here.gaussianCount(0), 1000u);
  for (int s = 0; s < 3; ++s) {
    ASSERT_EQ(here.gaussianCount(s), there.gaussianCount(s));
    for (std::size_t i = 0; i < here.gaussianCount(s); ++i) {
      const Gaussian<3> a = here.gaussian(i, s), b = there.gaussian(i, s);
      ASSERT_LT((a.mean + kShift - b.mean).norm(), 4e-6);  // two steps of the lattice and the rounding of 5e6 m
      ASSERT_LT((a.cov - b.cov).norm(), 4e-6 * here.grid().side(s));
      ASSERT_EQ(a.weight, b.weight);
    }
  }
}

}  // namespace
}  // namespace gaussmap::test
