// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "gaussmap/core/error.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/files/temporary_directory.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

namespace fs = std::filesystem;
using test::randomCloud;
using test::TemporaryDirectory;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Pose somePose(std::uint64_t seed) {
  Random random(seed);
  Pose pose;
  pose.translation = {10.0 * random.normal(), 10.0 * random.normal(), random.normal()};
  pose.rotation = {random.normal(), random.normal(), random.normal(), random.normal()};
  return normalised(pose);
}

using Cells = std::map<CellKey<3>, CellMoments<3>>;
Cells cellsOf(const MomentGrid<3>& grid) {
  Cells cells;
  for (std::size_t i = 0; i < grid.size(); ++i) cells.emplace(grid[i].key, grid[i].moments);
  EXPECT_EQ(cells.size(), grid.size());
  return cells;
}

Vector<3> moved(const Pose& pose, const Vector<3>& point) {
  PointBlock<3> block;
  block.size = 1;
  for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][0] = point(axis);
  transform(pose, block);
  return {block.coordinate[0][0], block.coordinate[1][0], block.coordinate[2][0]};
}

AccumulateOptions withThreads(int threads) {
  AccumulateOptions options;
  options.threads = threads;
  return options;
}

class AccumulateScans : public testing::Test {
 protected:
  FileScan write(const std::vector<Vector<3>>& points, const Pose& pose = {}) {
    const fs::path path = directory_.path() / ("scan" + std::to_string(next_++) + ".pcd");
    writePcd(path, points, PcdPrecision::Double, pose);
    return {path, pose};
  }
  PointCounts countsOf(const std::vector<Vector<3>>& points, const AccumulateOptions& options, const Pose& pose = {},
                       ScanFrame frame = ScanFrame::Sensor) {
    const FileScans scans({write(points, pose)}, frame);
    const AccumulatedScans all = accumulateScans(scans, options);
    EXPECT_EQ(all.counts.read, static_cast<std::int64_t>(points.size()));
    EXPECT_EQ(all.counts.read,
              all.counts.accepted + all.counts.non_finite + all.counts.at_sensor + all.counts.beyond_range);
    EXPECT_EQ(all.counts.accepted, all.moments.pointCount());
    EXPECT_EQ(readPoints(scans, options).size(), static_cast<std::size_t>(all.counts.accepted));
    return all.counts;
  }

  TemporaryDirectory directory_;
  int next_ = 0;
};

TEST_F(AccumulateScans, CountsThePointsThatTheirPosesMove) {
  MomentGrid<3> expected(0.1);
  std::vector<FileScan> scans;
  for (std::uint64_t scan = 0; scan < 5; ++scan) {
    const std::vector<Vector<3>> points = randomCloud<3>(2000, 80 + scan);
    scans.push_back(write(points, somePose(scan)));
    for (const Vector<3>& point : points) {
      const Vector<3> by_hand = scans.back().pose.rotation.toRotationMatrix() * point + scans.back().pose.translation;
      EXPECT_LT((moved(scans.back().pose, point) - by_hand).norm(), 1e-13);
      expected.addPoints({moved(scans.back().pose, point)});
    }
  }
  const AccumulatedScans all = accumulateScans(FileScans(scans), {});
  EXPECT_EQ(cellsOf(all.moments), cellsOf(expected));
  EXPECT_EQ(all.counts.accepted, 10000);
  MomentGrid<3> read(0.1);
  read.addPoints(readPoints(FileScans(scans), {}));
  EXPECT_EQ(cellsOf(read), cellsOf(expected));
}

TEST_F(AccumulateScans, GivesTheSameCellsForAnyOrderAndThreads) {
  std::vector<FileScan> scans;
  for (std::uint64_t scan = 0; scan < 12; ++scan)
    scans.push_back(write(randomCloud<3>(3000, 90 + scan), somePose(scan)));
  const Cells expected = cellsOf(accumulateScans(FileScans(scans), withThreads(1)).moments);
  Random random(1);
  for (const int threads : {1, 2, 0, 2, 2, 2}) {
    for (std::size_t i = scans.size(); i > 1; --i) std::swap(scans[i - 1], scans[random.below(i)]);
    const AccumulatedScans all = accumulateScans(FileScans(scans), withThreads(threads));
    EXPECT_EQ(cellsOf(all.moments), expected);
    EXPECT_EQ(all.counts.read, 36000);
    EXPECT_EQ(all.counts.accepted, 36000);
  }
}

TEST_F(AccumulateScans,
       GivesTheSameCellsForOneBigScanAndManySmall) {  // 300,001 points: several tasks, the last one short
  const std::vector<Vector<3>> points = randomCloud<3>(300001, 100);
  const Pose pose = somePose(7);
  const std::vector<FileScan> one = {write(points, pose)};
  std::vector<FileScan> many;
  for (std::size_t first = 0; first < points.size(); first += 30011)
    many.push_back(write({points.begin() + static_cast<std::ptrdiff_t>(first),
                          points.begin() + static_cast<std::ptrdiff_t>(std::min(points.size(), first + 30011))},
                         pose));
  const Cells expected = cellsOf(accumulateScans(FileScans(one), withThreads(1)).moments);
  std::int64_t count = 0;
  for (const auto& [key, moments] : expected) count += moments.count;
  EXPECT_EQ(count, 300001);
  for (const int threads : {1, 2, 0}) {
    EXPECT_EQ(cellsOf(accumulateScans(FileScans(one), withThreads(threads)).moments), expected);
    EXPECT_EQ(cellsOf(accumulateScans(FileScans(many), withThreads(threads)).moments), expected);
  }
}

TEST_F(AccumulateScans, InTheFrameOfTheMapMovesNothing) {
  const std::vector<Vector<3>> points = randomCloud<3>(1000, 101);
  MomentGrid<3> expected(0.1);
  expected.addPoints(points);
  EXPECT_EQ(cellsOf(accumulateScans(FileScans({write(points, somePose(3))}, ScanFrame::Map), {}).moments),
            cellsOf(expected));
}

TEST_F(AccumulateScans, LeavesOutWhatIsNoPoint) {
  const PointCounts counts = countsOf({{1, 2, 3},
                                       {kNaN, 0, 0},
                                       {0, kNaN, 0},
                                       {0, 0, kNaN},
                                       {kInfinity, 0, 0},
                                       {0, -kInfinity, 1},
                                       {0, 0, 0},
                                       {-0.0, 0.0, -0.0},
                                       {-4, 5, 6}},
                                      {}, somePose(4));
  EXPECT_EQ(counts.accepted, 2);
  EXPECT_EQ(counts.non_finite, 5);
  EXPECT_EQ(counts.at_sensor, 2);
  EXPECT_EQ(counts.beyond_range, 0);
}

TEST_F(AccumulateScans, LeavesOutWhatIsTooFarFromTheSensor) {
  AccumulateOptions options;
  options.max_range = 5.0;
  const std::vector<Vector<3>> points = {{3, 4, 0},     {3, 4, 0.001}, {0, 0, 5}, {0, 0, -6},
                                         {1e200, 0, 0}, {kNaN, 9, 9},  {0, 0, 0}};
  Pose pose;
  pose.translation = {100, 0, 0};  // the range counts, not the place in the map
  const PointCounts counts = countsOf(points, options, pose);
  EXPECT_EQ(counts.accepted, 2);
  EXPECT_EQ(counts.beyond_range, 3);
  EXPECT_EQ(counts.non_finite, 1);
  EXPECT_EQ(counts.at_sensor, 1);
}

TEST_F(AccumulateScans, InTheFrameOfTheMapMeasuresRangesFromTheSensor) {
  AccumulateOptions options;
  options.max_range = 5.0;
  Pose pose = somePose(5);
  pose.translation = {100, 0, 0};
  const PointCounts counts =
      countsOf({{103, 4, 0}, {103, 4, 0.001}, {0, 0, 0}, {100, 0, 0}}, options, pose, ScanFrame::Map);
  EXPECT_EQ(counts.accepted, 1);
  EXPECT_EQ(counts.beyond_range, 2);
  EXPECT_EQ(counts.at_sensor, 1);  // as in the sensor's frame: "no return", moved into the map by its driver
}

TEST_F(AccumulateScans, RefusesRangesThatAreNone) {
  AccumulateOptions options;
  for (const double range : {-1.0, kNaN}) {
    options.max_range = range;
    EXPECT_THROW(accumulateScans(FileScans({write({{1, 1, 1}})}), options), std::invalid_argument);
    EXPECT_THROW(readPoints(FileScans({write({{1, 1, 1}})}), options), std::invalid_argument);
  }
  options = {};
  for (const double resolution : {0.0, -1.0, kNaN, kInfinity}) {
    options.resolution = resolution;
    EXPECT_THROW(accumulateScans(FileScans({write({{1, 1, 1}})}), options), std::invalid_argument);
  }
}

TEST_F(AccumulateScans, NamesTheFileOfAPointThatIsTooFarForItsCell) {
  for (const double far : {1e10, 1e200, 1.7e308}) {
    for (const int threads : {1, 2}) {
      Pose turned;  // by 45 degrees about z: 1.7e308 becomes infinite
      turned.rotation = Pose::Rotation(std::cos(M_PI / 8), 0, 0, std::sin(M_PI / 8));
      const std::vector<FileScan> scans = {write({{1, 1, 1}}), write({{1, 1, 1}, {far, far, 0}}, turned)};
      try {
        accumulateScans(FileScans(scans), withThreads(threads));
        ADD_FAILURE() << "took a point at " << far;
      } catch (const std::out_of_range& error) {
        EXPECT_EQ(std::string(error.what()).find(scans[1].path.string() + ": "), 0u) << error.what();
      }
    }
  }
}

TEST_F(AccumulateScans, NamesTheFileThatIsDamaged) {
  const FileScan good = write(randomCloud<3>(1000, 102));
  const fs::path path =
      directory_.write("damaged.pcd",
                       "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
                       "POINTS 2\nDATA ascii\n1 2 3\n4 five 6\n");
  for (const int threads : {1, 2}) {
    try {
      accumulateScans(FileScans({good, {path, {}}, good}), withThreads(threads));
      ADD_FAILURE() << "took a damaged file";
    } catch (const FileError& error) {
      EXPECT_EQ(std::string(error.what()).find(path.string() + ": line 11"), 0u) << error.what();
    }
  }
  EXPECT_THROW(accumulateScans(FileScans({good, {directory_.path() / "missing.pcd", {}}}), {}), FileError);
}

TEST_F(AccumulateScans, OfNothingIsNothing) {
  const AccumulatedScans none = accumulateScans(MemoryScans(), {});
  EXPECT_TRUE(none.moments.empty());
  EXPECT_EQ(none.counts.read, 0);
  EXPECT_EQ(none.moments.resolution(), 0.1);
  EXPECT_TRUE(accumulateScans(FileScans({write({})}), {}).moments.empty());
}

TEST_F(AccumulateScans, ReportsEveryScanOnce) {
  std::vector<FileScan> scans;
  for (std::uint64_t scan = 0; scan < 9; ++scan) scans.push_back(write(randomCloud<3>(1000, 110 + scan)));
  for (const int threads : {1, 2}) {
    std::vector<AccumulateProgress> reports;
    const AccumulatedScans all =
        accumulateScans(FileScans(scans), withThreads(threads),
                        [&](const AccumulateProgress& progress) { reports.push_back(progress); });
    ASSERT_EQ(reports.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_EQ(reports[i].scans_done, i + 1);
      EXPECT_EQ(reports[i].scans, 9u);
      EXPECT_EQ(reports[i].points, static_cast<std::int64_t>(1000 * (i + 1)));
      EXPECT_LE(reports[i].cells, all.moments.size());
    }
    EXPECT_GT(reports.back().cells, 0u);
  }
}

}  // namespace
}  // namespace gaussmap
