// SPDX-License-Identifier: BSD-3-Clause
// The lengths of the rules for moving objects shrink with the cells: what has moved in a scene of a few centimetres is
// forgotten too.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "mapping/moving/default_lengths.h"
#include "mapping/online/online_scenes.h"

namespace gaussmap::test {
namespace {

using namespace detail;

constexpr double kScale = 0.02;  // the wall is 0.2 m away, the box in front of it 0.1 m

Scan smallScan(bool with_box) {
  Scan scan = wallScan(with_box);
  for (Eigen::Vector3d& point : scan.points) point *= kScale;
  return scan;
}
bool isOfBox(const Eigen::Vector3d& point) {
  return point.x() < 8.0 * kScale;
}

std::size_t cellsOfBox(const GaussianMap<3>& map) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) count += isOfBox(map.gaussian(i, 0).mean);
  return count;
}

/// The lengths of cells of 15 mm and more.
const VisibilityOptions kUsual = {0.3, 0.35};

TEST(SmallCells, OnlineMappingForgetsWhatHasMoved) {
  for (const bool usual : {false, true}) {
    OnlineOptions options = wallOptions();
    options.map.resolution = 0.002;
    if (usual) options.visibility = kUsual;
    OnlineMapper<3> mapper(options);
    for (int i = 0; i < 2; ++i) mapper.add(smallScan(true));
    ASSERT_GE(cellsOfBox(mapper.map()), 100u);
    for (int i = 0; i < 5; ++i) mapper.add(smallScan(false));
    const GaussianMap<3> map = mapper.map();
    EXPECT_EQ(cellsOfBox(map) == 0, !usual);
    EXPECT_GT(map.gaussianCount(0), 1000u);  // the wall
  }
}

TEST(SmallCells, CleaningFindsThePointsOfWhatHasMoved) {
  const auto scans = std::make_shared<MemoryScans>();
  for (int i = 0; i < 8; ++i) scans->add(smallScan(i < 2));
  for (const bool usual : {false, true}) {
    MovingPointOptions options;
    options.resolution = 0.002;
    if (usual) options.evidence.visibility = kUsual;
    const MovingPoints moving(scans, options);
    double on = 0.0, found = 0.0, wrong = 0.0;
    for (std::size_t i = 0; i < scans->size(); ++i) {
      const std::vector<bool> flags = moving.inScan(i);
      const Scan scan = scans->read(i);
      for (std::size_t p = 0; p < flags.size(); ++p) {
        if (!isReturn(scan.points[p])) continue;
        on += isOfBox(scan.points[p]);
        (isOfBox(scan.points[p]) ? found : wrong) += flags[p];
      }
    }
    EXPECT_GT(on, 200.0);
    EXPECT_EQ(found, usual ? 0.0 : on);
    EXPECT_EQ(wrong, 0.0);
  }
}

TEST(SmallCells, FreePointsAreThoseBeforeTheSurfacesOfTheMap) {
  OnlineOptions mapping = wallOptions();
  mapping.map.resolution = 0.002;
  OnlineMapper<3> mapper(mapping);
  mapper.add(smallScan(false));
  const std::vector<Eigen::Vector3d> points = inMap(smallScan(true));
  for (const bool usual : {false, true}) {
    FreePointOptions options;
    if (usual) options.visibility = kUsual;
    const std::vector<bool> free = freePoints(mapper.map(), points, Eigen::Vector3d::Zero(), options);
    std::size_t of_box = 0, of_wall = 0;
    for (std::size_t p = 0; p < points.size(); ++p) (isOfBox(points[p]) ? of_box : of_wall) += free[p];
    EXPECT_EQ(of_box > 100, !usual) << of_box;
    EXPECT_EQ(of_wall, 0u);
  }
}

TEST(SmallCells, TheDefaultLengthsShrinkWithSmallCells) {
  for (const double side : {0.015, 0.02, 0.05, 0.1, 0.2, 1.0}) {
    const VisibilityOptions sight = forCells(VisibilityOptions(), side);
    EXPECT_EQ(*sight.tolerance, 0.3);
    EXPECT_EQ(*sight.clearance, 0.35);
    EXPECT_EQ(*sight.spacing, 0.03);
    EXPECT_EQ(*forCells(MovingCellOptions(), side).link, 0.2);
    EXPECT_EQ(*forCells(MovingCellOptions(), side).reach, 0.5);
    EXPECT_EQ(*forCells(SharedCellOptions(), side).reach, 0.6);
    EXPECT_EQ(*forCells(SharedCellOptions(), side).flatness, 0.04);
    EXPECT_EQ(*forCells(SharedCellOptions(), side).noise, 0.01);
    EXPECT_EQ(*forCells(SharedCellOptions(), side).extent, 0.05);
  }
  EXPECT_NEAR(*forCells(VisibilityOptions(), 0.002).tolerance, 3 * 0.002, 1e-15);
  EXPECT_NEAR(*forCells(MovingCellOptions(), 0.002).reach, 5 * 0.002, 1e-15);
  EXPECT_NEAR(*forCells(SharedCellOptions(), 0.002).flatness, 0.4 * 0.002, 1e-15);
  double before = 0.0;
  for (double side = 1e-4; side < 0.02; side *= 1.01) {  // grows steadily
    const double now = lengthFactor(side);
    EXPECT_GT(now, before * (1.0 - 1e-12));
    EXPECT_LE(now, std::max(before * 1.021, 1e-3)) << side;
    before = now;
  }
  VisibilityOptions given;
  given.tolerance = 0.0;
  EXPECT_EQ(*forCells(given, 0.002).tolerance, 0.0);
}

}  // namespace
}  // namespace gaussmap::test
