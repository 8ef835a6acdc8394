// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/moving/moving_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/unreadable_scans.h"
#include "gaussmap/core/error.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"
#include "io/files/temporary_directory.h"
#include "mesh/shapes.h"
#include "simulation/lidar.h"

namespace gaussmap {
using namespace detail;

namespace {

using Eigen::Vector3d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kFloor = -0.113;  // in the middle of cells: the box shares them with it

/// A room with a column, through which a box drives on the floor.
World room() {
  TriangleMesh mesh = boxMesh({-8.03, -7.07, kFloor}, {8.05, 7.02, 4.04});
  append(mesh, boxMesh({-2.3, 3.1, kFloor}, {-1.7, 3.7, 4.04}));
  return World(mesh, {{boxMesh({1.5, -4.5, kFloor}, {3.0, -3.0, 1.2}), {0.0, 1.0, 0.0}}});
}

/// A rounded number of metres: nothing is lost beside a large one.
Vector3d rounded(const Vector3d& p) {
  return (p * 65536.0).array().round() / 65536.0;
}

std::vector<SimulatedScan> driveBy() {
  LidarOptions lidar;
  lidar.rings = 48;
  lidar.columns = 720;
  lidar.lowest_deg = -40.0;
  lidar.highest_deg = 25.0;
  lidar.noise = 0.003;
  const World world = room();
  std::vector<SimulatedScan> scans;
  for (int i = 0; i < 9; ++i) {
    const Pose pose{rounded({-3.0 - 0.1 * i, -1.0 + 0.2 * i, 1.6}), Pose::Rotation::Identity()};
    scans.push_back(simulateScan(world, pose, lidar, std::uint64_t(i + 1), i));
    for (Vector3d& point : scans.back().points) point = rounded(point);
  }
  return scans;
}

class FindMovingPoints : public testing::Test {
 protected:
  FileScan write(const std::vector<Vector<3>>& points, const Pose& pose) {
    const auto path = directory_.path() / ("scan" + std::to_string(next_++) + ".pcd");
    writePcd(path, points, PcdPrecision::Double, pose);
    return {path, pose};
  }
  std::vector<FileScan> write(const std::vector<SimulatedScan>& scans, const Vector3d& offset = {0, 0, 0}) {
    std::vector<FileScan> sources;
    for (const SimulatedScan& scan : scans)
      sources.push_back(write(scan.points, {scan.pose.translation + offset, scan.pose.rotation}));
    return sources;
  }

  test::TemporaryDirectory directory_;
  int next_ = 0;
};

MovingPointOptions withCells(double resolution) {
  MovingPointOptions options;
  options.resolution = resolution;
  return options;
}

using Flags = std::vector<std::vector<bool>>;
Flags flagsOf(const MovingPoints& moving) {
  Flags flags;
  for (std::size_t i = 0; i < moving.scans().size(); ++i) flags.push_back(moving.inScan(i));
  return flags;
}

struct Counts {
  std::size_t box = 0, box_kept = 0;              // points on the box above the floor
  std::size_t under = 0, under_lost = 0;          // static points of the floor where the box came along
  std::size_t elsewhere = 0, elsewhere_lost = 0;  // all other static points
};
Counts countsOf(const std::vector<SimulatedScan>& scans, const Flags& flags) {
  Counts counts;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(flags[i].size(), scans[i].points.size());
    for (std::size_t p = 0; p < flags[i].size(); ++p) {
      const Vector3d& place = scans[i].truth[p];
      const bool on_way = place.x() > 1.5 && place.x() < 3.0 && place.y() > -4.5 && place.z() < 0.1;
      if (scans[i].labels[p] == SurfaceLabel::Moving) {
        counts.box += place.z() > kFloor + 0.1;
        counts.box_kept += place.z() > kFloor + 0.1 && !flags[i][p];
      } else if (on_way) {
        ++counts.under;
        counts.under_lost += flags[i][p];
      } else {
        ++counts.elsewhere;
        counts.elsewhere_lost += flags[i][p];
      }
    }
  }
  return counts;
}

TEST_F(FindMovingPoints, TakesTheWholeBoxAndNothingElse) {
  const auto scans = driveBy();
  const auto sources = write(scans);
  for (const double resolution : {0.2, 0.1}) {
    const MovingPoints moving(std::make_shared<const FileScans>(sources), withCells(resolution));
    const Counts counts = countsOf(scans, flagsOf(moving));
    EXPECT_GT(counts.box, 2000u);
    EXPECT_GT(counts.under, 3000u);
    EXPECT_GT(counts.elsewhere, 200000u);
    EXPECT_LT(counts.box_kept, counts.box / 100) << resolution;  // faces seen so flat that few points lie on them
    EXPECT_EQ(counts.under_lost, 0u) << resolution;
    EXPECT_EQ(counts.elsewhere_lost, 0u) << resolution;
    EXPECT_EQ(moving.counts().accepted, moving.counts().read);
    EXPECT_EQ(moving.movingCells().size(), moving.map().cellCount(0));
    EXPECT_EQ(moving.evidence().cells.size(), moving.map().cellCount(0));
    EXPECT_EQ(moving.map().grid().side(0), resolution);
  }
}

TEST_F(FindMovingPoints, TellsTheBoxFromTheFloorBySurfacesInTheCellsTheyShare) {
  const auto scans = driveBy();
  const auto sources = write(scans);
  MovingPointOptions options = withCells(0.2);
  const auto shareKept = [&] {  // of the box's points in the cells of the floor, but clear of it
    const Flags flags = flagsOf(MovingPoints(std::make_shared<const FileScans>(sources), options));
    double kept = 0.0, all = 0.0;
    for (std::size_t i = 0; i < scans.size(); ++i)
      for (std::size_t p = 0; p < flags[i].size(); ++p) {
        const double z = scans[i].truth[p].z();
        if (scans[i].labels[p] != SurfaceLabel::Moving || z < kFloor + 0.03 || z > 0.0) continue;
        all += 1.0;
        kept += !flags[i][p];
      }
    EXPECT_GT(all, 100.0);
    return kept / all;
  };
  EXPECT_LT(shareKept(), 0.02);
  options.shared.flatness = 0.0;  // no surface is so flat
  EXPECT_GT(shareKept(), 0.8);
}

TEST_F(FindMovingPoints, KeepsInSharedCellsWhatIsThereBeforeAndAfterTheBox) {
  auto scans = driveBy();
  const Vector3d above_the_floor(1.52, -0.3, kFloor + 0.09);  // behind the side of the box at seconds 3 and 4
  for (SimulatedScan& scan : scans) scan.points.push_back(rounded(above_the_floor - scan.pose.translation));
  const Flags flags = flagsOf(MovingPoints(std::make_shared<const FileScans>(write(scans))));
  for (const std::size_t i : {0u, 1u, 7u, 8u}) EXPECT_FALSE(flags[i].back()) << i;
  for (const std::size_t i : {3u, 4u}) EXPECT_TRUE(flags[i].back()) << i;
}

TEST_F(FindMovingPoints, AsksAFloorHowRoughItIs) {
  auto scans = driveBy();
  Random random(5);
  for (SimulatedScan& scan : scans)
    for (std::size_t p = 0; p < scan.points.size(); ++p)
      if (scan.labels[p] == SurfaceLabel::Static && scan.truth[p].z() < kFloor + 0.01)
        scan.points[p].z() += 0.015 * random.normal();
  const Counts counts = countsOf(scans, flagsOf(MovingPoints(std::make_shared<const FileScans>(write(scans)))));
  EXPECT_LT(counts.under_lost + counts.elsewhere_lost, 6u);  // with two standard deviations 22
  EXPECT_LT(counts.box_kept, counts.box / 20);
}

TEST_F(FindMovingPoints, FindsNothingWhereNothingMoves) {
  auto scans = driveBy();
  for (SimulatedScan& scan : scans) {
    std::vector<Vector3d> still;
    for (std::size_t p = 0; p < scan.points.size(); ++p)
      if (scan.labels[p] == SurfaceLabel::Static) still.push_back(scan.points[p]);
    scan.points = still;
  }
  for (const std::vector<bool>& flags : flagsOf(MovingPoints(std::make_shared<const FileScans>(write(scans)))))
    EXPECT_EQ(std::count(flags.begin(), flags.end(), true), 0);
}

TEST_F(FindMovingPoints, GivesTheSameFlagsFarFromTheOrigin) {
  const auto scans = driveBy();
  // Cells of a power of two and offsets of whole cells of the coarsest scale: coordinates lose nothing.
  const Flags near = flagsOf(MovingPoints(std::make_shared<const FileScans>(write(scans)), withCells(0.25)));
  EXPECT_EQ(flagsOf(MovingPoints(std::make_shared<const FileScans>(write(scans, {1e7 + 8.0, -1e7 - 8.0, 9e3})),
                                 withCells(0.25))),
            near);
  EXPECT_LT(countsOf(scans, near).box_kept, 30u);
}

TEST_F(FindMovingPoints, GivesTheSameFlagsForAnyNumberOfThreads) {
  const auto scans = driveBy();
  const auto sources = write(scans);
  MovingPointOptions options;
  options.evidence.threads = 1;
  const Flags one = flagsOf(MovingPoints(std::make_shared<const FileScans>(sources), options));
  for (const int threads : {2, 0}) {
    options.evidence.threads = threads;
    EXPECT_EQ(flagsOf(MovingPoints(std::make_shared<const FileScans>(sources), options)), one);
  }
}

TEST_F(FindMovingPoints, IsNotDisturbedByScansOfNoUse) {
  const auto scans = driveBy();
  std::vector<FileScan> sources = write(scans);
  const Flags clean = flagsOf(MovingPoints(std::make_shared<const FileScans>(sources)));
  const Pose aside{{-3, 0, 1.5}, Pose::Rotation::Identity()};
  sources.push_back(write({}, aside));
  sources.push_back(write({{4, 0, 0}}, aside));
  sources.push_back(write(std::vector<Vector<3>>(1000, {kNaN, kNaN, kNaN}), aside));
  sources.push_back(write(std::vector<Vector<3>>(1000, {0, 0, 0}), aside));
  const std::size_t in_the_air = sources.size();  // where others see that nothing is
  sources.push_back(write(std::vector<Vector<3>>(1000, {1e-9, -1e-9, 1e-9}), aside));  // all but at the sensor
  sources.push_back(write(std::vector<Vector<3>>(1000, {2, 3, 1}), aside));
  const MovingPoints moving(std::make_shared<const FileScans>(sources));
  Flags flags = flagsOf(moving);
  const std::size_t sizes[] = {0, 1, 1000, 1000, 1000, 1000};
  EXPECT_EQ(moving.counts().non_finite, 1000);
  EXPECT_EQ(moving.counts().at_sensor, 1000);
  for (std::size_t i = clean.size(); i < flags.size(); ++i)
    EXPECT_EQ(flags[i], std::vector<bool>(sizes[i - clean.size()], i >= in_the_air)) << i - clean.size();
  flags.resize(clean.size());
  const Counts before = countsOf(scans, clean), after = countsOf(scans, flags);
  EXPECT_EQ(after.box_kept, before.box_kept);
  EXPECT_EQ(after.under_lost, 0u);
  EXPECT_EQ(after.elsewhere_lost, 0u);
}

TEST_F(FindMovingPoints, KeepsWhatAScanFromInsideAWallCannotSee) {
  const auto scans = driveBy();
  std::vector<FileScan> sources = write(scans);
  LidarOptions lidar;
  lidar.rings = 48;
  lidar.columns = 720;
  for (const Vector3d& inside : {Vector3d(-2.0, 3.4, 1.0), Vector3d(8.05, 0.0, 1.0)}) {  // the column, a wall's plane
    const SimulatedScan scan = simulateScan(room(), {inside, Pose::Rotation::Identity()}, lidar, 5, 3.0);
    EXPECT_FALSE(scan.points.empty());
    sources.push_back(write(scan.points, scan.pose));
  }
  Flags flags = flagsOf(MovingPoints(std::make_shared<const FileScans>(sources)));
  EXPECT_EQ(std::count(flags[9].begin(), flags[9].end(), true), 0);
  flags.resize(9);
  const Counts counts = countsOf(scans, flags);
  EXPECT_LT(counts.box_kept, counts.box / 100);
  EXPECT_EQ(counts.under_lost + counts.elsewhere_lost, 0u);
}

TEST_F(FindMovingPoints, LeavesOutPointsBeyondTheMaximumRange) {
  const auto scans = driveBy();
  MovingPointOptions options;
  options.evidence.max_range = 5.0;
  const MovingPoints moving(std::make_shared<const FileScans>(write(scans)), options);
  EXPECT_GT(moving.counts().beyond_range, 0);
  std::size_t found = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::vector<bool> flags = moving.inScan(i);
    for (std::size_t p = 0; p < flags.size(); ++p) {
      if (!flags[p]) continue;
      ASSERT_LE(scans[i].points[p].norm(), 5.0);
      ++found;
    }
  }
  EXPECT_GT(found, 500u);
}

TEST_F(FindMovingPoints, NeedsNoScans) {
  const MovingPoints none(std::make_shared<const MemoryScans>());
  EXPECT_EQ(none.scans().size(), 0u);
  EXPECT_TRUE(none.map().empty());
  EXPECT_THROW(none.inScan(0), std::out_of_range);
  const auto one = write({driveBy().front()});
  for (const std::vector<bool>& flags : flagsOf(MovingPoints(std::make_shared<const FileScans>(one))))
    EXPECT_EQ(std::count(flags.begin(), flags.end(), true), 0);
}

TEST_F(FindMovingPoints, TellsHowFarEachStepIs) {
  const auto sources = write(driveBy());
  std::vector<std::pair<MovingPointStep, std::size_t>> reports;
  const MovingPoints moving(std::make_shared<const FileScans>(sources), {},
                            [&](MovingPointStep step, std::size_t done) { reports.emplace_back(step, done); });
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  for (const MovingPointStep step : {MovingPointStep::Counting, MovingPointStep::Looking, MovingPointStep::Sharing})
    EXPECT_EQ(std::count(reports.begin(), reports.end(), std::pair(step, sources.size())), 1);
}

TEST_F(FindMovingPoints, SaysWhichOptionIsNotUsableBeforeAnyScanIsRead) {
  const auto missing = std::make_shared<const test::UnreadableScans>();
  const auto refusal = [&](auto change) -> std::string {
    MovingPointOptions options;
    change(options);
    try {
      MovingPoints moving(missing, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal([](auto& o) { o.resolution = 0.0; }).find("resolution = 0"), std::string::npos);
  EXPECT_EQ(refusal([](auto& o) { o.evidence.max_range = -2.0; }), "max_range = -2: must not be negative");
  EXPECT_EQ(refusal([](auto& o) { o.cells.link = kNaN; }), "link = nan: must be 0 to 1000 cells");
  EXPECT_EQ(refusal([](auto& o) { o.shared.reach = 201.0; }), "reach of a surface = 201: must be 0 to 1000 cells");
  EXPECT_EQ(refusal([](auto& o) { o.shared.flatness = -1.0; }), "flatness = -1: must not be negative");
  EXPECT_EQ(refusal([](auto& o) { o.shared.noise = kNaN; }), "noise = nan: must not be negative");
  EXPECT_THROW(MovingPoints(missing, {}), FileError);
}

}  // namespace
}  // namespace gaussmap
