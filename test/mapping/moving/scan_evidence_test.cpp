// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/moving/scan_evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "core/unreadable_scans.h"
#include "gaussmap/core/error.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"
#include "io/files/temporary_directory.h"
#include "mesh/shapes.h"
#include "sensor/views.h"
#include "simulation/lidar.h"

namespace gaussmap {
using namespace detail;

namespace {

using Eigen::Vector3d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Pose pose(double x, double y, double z) {
  return normalised({{x, y, z}, {1.0, 0.02, -0.03, 0.2}});
}

/// A box that hangs in the air at time 0 and has gone at time 1.
MovingObject box() {
  return {boxMesh({2, -0.5, 1.2}, {3, 0.5, 2.2}), {0, 0, 100}};
}

/// A closed room of 12 m x 12 m x 4 m with the box in it, seen twice from the same place.
std::vector<SimulatedScan> roomScans() {
  const World room(boxMesh({-6.03, -6.07, 0.01}, {6.05, 6.02, 4.04}), {box()});
  LidarOptions lidar;
  lidar.rings = 48;
  lidar.columns = 720;
  lidar.lowest_deg = -40.0;
  lidar.highest_deg = 40.0;
  lidar.noise = 0.0;
  return {simulateScan(room, pose(-2, 1.5, 1.7), lidar, 1, 0.0), simulateScan(room, pose(-2, 1.5, 1.7), lidar, 1, 1.0)};
}

class GatherEvidence : public testing::Test {
 protected:
  FileScan write(const std::vector<Vector<3>>& points, const Pose& pose) {
    const auto path = directory_.path() / ("scan" + std::to_string(next_++) + ".pcd");
    writePcd(path, points, PcdPrecision::Double, pose);
    return {path, pose};
  }
  std::vector<FileScan> write(const std::vector<SimulatedScan>& scans) {
    std::vector<FileScan> sources;
    for (const SimulatedScan& scan : scans) sources.push_back(write(scan.points, scan.pose));
    return sources;
  }

  test::TemporaryDirectory directory_;
  int next_ = 0;
};

GaussianMap<3> mapOf(const FileScans& scans, const ScanEvidenceOptions& options = {}) {
  return build<3>(accumulateScans(scans, {0.25, options.max_range, 1}).moments, MapOptions{0.25, 6, 3, 0.0});
}

std::set<std::size_t> cellsOf(const GaussianMap<3>& map, const SimulatedScan& scan, SurfaceLabel label) {
  std::set<std::size_t> cells;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const auto cell = map.find(map.grid().keyOf(scan.pose * scan.points[i]), 0);
    if (cell && scan.labels[i] == label) cells.insert(*cell);
  }
  return cells;
}

/// The cells of the box: hit by the first scan, missed by the second. All others: hit when they were seen, never
/// missed.
void expectThatTheBoxHasGone(const GaussianMap<3>& map, const ScanEvidence& evidence,
                             const std::vector<SimulatedScan>& scans) {
  const auto in_box = cellsOf(map, scans[0], SurfaceLabel::Moving);
  const auto first = cellsOf(map, scans[0], SurfaceLabel::Static),
             second = cellsOf(map, scans[1], SurfaceLabel::Static);
  ASSERT_EQ(evidence.cells.size(), map.cellCount(0));
  EXPECT_GT(in_box.size(), 20u);
  std::size_t twice = 0, shadowed = 0;
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    const Evidence& said = evidence.cells[cell];
    const bool is_box = in_box.count(cell) > 0;
    const std::uint32_t hits = is_box ? 1u : std::uint32_t(first.count(cell) + second.count(cell));
    ASSERT_EQ(said.hits, hits);
    ASSERT_EQ(said.misses, is_box ? 1u : 0u) << map.gaussian(cell, 0).mean.transpose();
    ASSERT_EQ(said.first_hit, is_box || first.count(cell) > 0 ? 0u : 1u);
    ASSERT_EQ(said.last_hit, is_box || second.count(cell) == 0 ? 0u : 1u);
    twice += hits == 2;
    shadowed += hits == 1 && !is_box && second.count(cell) > 0;
  }
  EXPECT_GT(twice, 10 * in_box.size());
  EXPECT_GT(shadowed, in_box.size() / 2);  // the wall behind the box
}

TEST_F(GatherEvidence, CountsWhatHasGoneAsMissedAndTheWallBehindAsHit) {
  const auto scans = roomScans();
  const auto sources = write(scans);
  const GaussianMap<3> map = mapOf(FileScans(sources));
  const ScanEvidence evidence = gatherEvidence(map, FileScans(sources));
  expectThatTheBoxHasGone(map, evidence, scans);
  EXPECT_LE(evidence.cells_visited, 2 * map.cellCount(0));
  EXPECT_GT(evidence.cells_visited, 0u);
  EXPECT_LE(evidence.cells_tested, 2 * (map.cellCount(1) + map.cellCount(2)));
}

TEST_F(GatherEvidence, TakesPointsInTheFrameOfTheMap) {
  const auto scans = roomScans();
  std::vector<FileScan> sources;
  for (const SimulatedScan& scan : scans) {
    std::vector<Vector<3>> in_map;
    for (const Vector3d& point : scan.points) in_map.push_back(scan.pose * point);
    sources.push_back(write(in_map, scan.pose));
  }
  const FileScans files(sources, ScanFrame::Map);
  const GaussianMap<3> map = mapOf(files);
  expectThatTheBoxHasGone(map, gatherEvidence(map, files), scans);
}

TEST_F(GatherEvidence, LooksThroughTheProjectionThatIsGiven) {
  const auto scans = roomScans();
  const auto sources = write(scans);
  const GaussianMap<3> map = mapOf(FileScans(sources));
  ScanEvidenceOptions options;
  options.projection = test::lidar(48, -40.85, 40.85, 360);
  expectThatTheBoxHasGone(map, gatherEvidence(map, FileScans(sources), options), scans);

  options.projection = test::lidar(48, -80, -60, 360);  // looks elsewhere
  const ScanEvidence blind = gatherEvidence(map, FileScans(sources), options);
  const ScanEvidence found = gatherEvidence(map, FileScans(sources));
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    ASSERT_EQ(blind.cells[cell].hits, found.cells[cell].hits);
    ASSERT_EQ(blind.cells[cell].misses, 0u);
  }
}

TEST_F(GatherEvidence, TakesAPointInTheCellForAHitWhateverOtherBeamsDo) {
  // A wall 5.05 m away, then 5.95 m: in the same cells of 1 m, but 0.9 m behind the mean of many earlier points.
  std::vector<FileScan> sources;
  for (const double distance : {5.05, 5.05, 5.05, 5.05, 5.05, 5.05, 5.05, 5.05, 5.05, 5.95}) {
    std::vector<Vector<3>> points;
    for (double y = -2.0; y < 2.0; y += 0.05)
      for (double z = -2.0; z < 2.0; z += 0.05) points.push_back(distance * Vector3d(1.0, 0.2 * y, 0.2 * z));
    sources.push_back(write(points, {}));
  }
  const GaussianMap<3> map =
      build<3>(accumulateScans(FileScans(sources), {1.0, 100.0, 1}).moments, MapOptions{1.0, 6, 3, 0.0});
  ScanEvidenceOptions options;
  options.projection = test::lidar(40, -25, 25, 360);
  const ScanEvidence evidence = gatherEvidence(map, FileScans(sources), options);
  const RangeImage last(*options.projection, readPoints(FileScans({sources.back()}), {}));
  std::size_t decided = 0;
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    if (evidence.cells[cell].last_hit != 9) continue;
    EXPECT_EQ(evidence.cells[cell].misses, 0u);
    decided += visibilityOf(last, map.gaussian(cell, 0).mean) == Visibility::PassedThrough;
  }
  EXPECT_GT(decided, 0u);
}

TEST_F(GatherEvidence, AsksForTheToleranceThatIsGiven) {
  const auto sources = write(roomScans());
  const GaussianMap<3> map = mapOf(FileScans(sources));
  ScanEvidenceOptions options;
  options.visibility.tolerance = 8.0;  // no wall is so far behind the box
  for (const Evidence& said : gatherEvidence(map, FileScans(sources), options).cells) ASSERT_EQ(said.misses, 0u);
}

TEST_F(GatherEvidence, FreesTheWayOfBeamsThatEndBeyondTheMaximumRange) {
  const auto scans = roomScans();
  const auto sources = write(scans);
  ScanEvidenceOptions options;
  options.max_range = 5.5;  // the wall behind the box is 8 m away
  const GaussianMap<3> map = mapOf(FileScans(sources), options);
  EXPECT_LT(map.cellCount(0), mapOf(FileScans(sources)).cellCount(0));
  const auto in_box = cellsOf(map, scans[0], SurfaceLabel::Moving);
  EXPECT_GT(in_box.size(), 20u);
  const ScanEvidence evidence = gatherEvidence(map, FileScans(sources), options);
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    ASSERT_GE(evidence.cells[cell].hits, 1u);
    ASSERT_EQ(evidence.cells[cell].misses, in_box.count(cell));
  }

  options.max_range = 0.0;  // no point hits anything
  for (const Evidence& said : gatherEvidence(map, FileScans(sources), options).cells) ASSERT_EQ(said.hits, 0u);
}

TEST_F(GatherEvidence, TakesNoReturnForFreeSpaceOnlyIfAsked) {  // the box under the open sky, then nothing
  const World sky({}, {box()});
  LidarOptions lidar;
  lidar.rings = 48;
  lidar.columns = 720;
  lidar.noise = 0.0;
  std::vector<SimulatedScan> scans;
  for (const double time : {0.0, 1.0}) scans.push_back(simulateScan(sky, pose(-2, 1.5, 1.7), lidar, 1, time));
  ASSERT_TRUE(scans[1].points.empty());
  const auto sources = write(scans);
  const GaussianMap<3> map = mapOf(FileScans(sources));
  ScanEvidenceOptions options;
  const auto misses = [&] {
    std::uint32_t sum = 0;
    for (const Evidence& said : gatherEvidence(map, FileScans(sources), options).cells) {
      EXPECT_EQ(said.hits, 1u);
      EXPECT_LE(said.misses, 1u);
      sum += said.misses;
    }
    return sum;
  };
  EXPECT_EQ(misses(), 0u);
  options.no_return_is_free = 20.0;
  EXPECT_EQ(misses(), 0u);  // an empty scan does not say where its sensor looked
  options.projection = test::lidar(48, -26, 16, 360);
  EXPECT_EQ(misses(), map.cellCount(0));
  options.no_return_is_free = 3.0;  // not so far as the box
  EXPECT_EQ(misses(), 0u);
  options.no_return_is_free.reset();
  EXPECT_EQ(misses(), 0u);
}

TEST_F(GatherEvidence, TakesOrganisedCloudsOfDepthCameras) {
  // A wall 5 m before the camera; in the first image a board 2 m before it; a tenth of the pixels without depth.
  const PlanarProjection camera = test::camera();
  Random random(3);
  std::vector<FileScan> sources;
  for (const bool board : {true, false}) {
    std::vector<float> numbers;
    for (int row = 0; row < camera.rows; ++row)
      for (int column = 0; column < camera.columns; ++column) {
        const Vector3d direction((column - camera.cx) / camera.fx, (row - camera.cy) / camera.fy, 1.0);
        const bool on_board = board && direction.head<2>().cwiseAbs().maxCoeff() < 0.2;
        const double depth = random.below(10) == 0 ? kNaN : on_board ? 2.0 : 5.0;
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(float(depth * direction(axis)));
      }
    const auto path = directory_.path() / (board ? "board.pcd" : "wall.pcd");
    const std::size_t stride = 3 * sizeof(float);
    writePcd(path, numbers.size() / 3,
             {pcdOutput("x", &numbers[0], 1, stride), pcdOutput("y", &numbers[1], 1, stride),
              pcdOutput("z", &numbers[2], 1, stride)},
             Pose{}, std::size_t(camera.columns));
    sources.push_back({path, {}});
  }
  const GaussianMap<3> map = mapOf(FileScans(sources));
  const ScanEvidence evidence = gatherEvidence(map, FileScans(sources));
  std::size_t of_board = 0;
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    const bool is_board = map.gaussian(cell, 0).mean.z() < 3.0;
    ASSERT_EQ(evidence.cells[cell].misses, is_board ? 1u : 0u);
    of_board += is_board;
  }
  EXPECT_GT(of_board, 9u);
}

TEST_F(GatherEvidence, GivesTheSameForAnyNumberOfThreads) {
  const World room(boxMesh({-6, -6, 0}, {6, 6, 4}), {{boxMesh({2, -3, 0.5}, {3, -2, 1.5}), {0, 0.3, 0}}});
  LidarOptions lidar;
  lidar.rings = 16;
  lidar.columns = 180;
  std::vector<SimulatedScan> scans;
  for (int i = 0; i < 35; ++i)  // more than are in memory at a time
    scans.push_back(simulateScan(room, pose(-3 + 0.1 * i, 0.5, 1.5), lidar, std::uint64_t(i), i));
  const auto sources = write(scans);
  const GaussianMap<3> map = mapOf(FileScans(sources));
  ScanEvidenceOptions options;
  options.threads = 1;
  std::vector<std::size_t> done;
  const ScanEvidence one =
      gatherEvidence(map, FileScans(sources), options, [&](std::size_t count) { done.push_back(count); });
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.back(), 35u);
  for (std::uint32_t i = 0; i < 35; ++i)
    for (const SurfaceLabel label : {SurfaceLabel::Static, SurfaceLabel::Moving})
      for (const std::size_t cell : cellsOf(map, scans[i], label)) {
        ASSERT_LE(one.cells[cell].first_hit, i);
        ASSERT_GE(one.cells[cell].last_hit, i);
      }
  std::uint32_t misses = 0;
  for (const int threads : {2, 0}) {
    options.threads = threads;
    const ScanEvidence many = gatherEvidence(map, FileScans(sources), options);
    EXPECT_EQ(many.cells_tested, one.cells_tested);
    EXPECT_EQ(many.cells_visited, one.cells_visited);
    for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
      const Evidence &a = one.cells[cell], &b = many.cells[cell];
      ASSERT_EQ(a.hits, b.hits);
      ASSERT_EQ(a.misses, b.misses);
      ASSERT_EQ(a.first_hit, b.first_hit);
      ASSERT_EQ(a.last_hit, b.last_hit);
      misses += a.misses;
    }
  }
  EXPECT_GT(misses, 100u);
}

TEST_F(GatherEvidence, TakesEmptyMapsAndScansOfNoUse) {
  EXPECT_TRUE(gatherEvidence(GaussianMap<3>{}, MemoryScans()).cells.empty());
  const GaussianMap<3> map = build<3>(std::vector<Vector<3>>{{1, 0, 0}, {3, 1, 0}}, MapOptions{0.25, 6, 3, 0.0});
  const std::vector<FileScan> scans = {write({}, {}), write({{1, 0, 0}}, {}),
                                       write({{kNaN, kNaN, kNaN}, {0, 0, 0}, {kNaN, 0, 1}}, {}),
                                       write(std::vector<Vector<3>>(5, {1, 0, 0}), {})};
  const ScanEvidence evidence = gatherEvidence(map, FileScans(scans));
  const std::size_t near = *map.find(map.grid().keyOf({1, 0, 0}), 0);
  EXPECT_EQ(evidence.cells[near].hits, 2u);
  EXPECT_EQ(evidence.cells[near].first_hit, 1u);
  EXPECT_EQ(evidence.cells[near].last_hit, 3u);
  EXPECT_EQ(evidence.cells[1 - near].hits, 0u);
  EXPECT_EQ(evidence.cells[0].misses + evidence.cells[1].misses, 0u);
}

TEST_F(GatherEvidence, NamesTheFileThatIsNotUsable) {
  const GaussianMap<3> map(MapOptions{0.25, 6, 3, 0.0});
  EXPECT_THROW(gatherEvidence(map, test::UnreadableScans()), FileError);
  const FileScan far = write({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, pose(1e12, 0, 0));
  try {
    gatherEvidence(map, FileScans({far}));
    FAIL();
  } catch (const std::out_of_range& error) {
    EXPECT_NE(std::string(error.what()).find(far.path.string()), std::string::npos) << error.what();
  }
}

TEST_F(GatherEvidence, NamesTheOptionThatIsNotUsable) {
  const auto refusal = [&](auto change) -> std::string {
    ScanEvidenceOptions options;
    change(options);
    try {
      gatherEvidence(GaussianMap<3>{}, test::UnreadableScans(), options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal([](auto& o) { o.max_range = -1.0; }), "max_range = -1: must not be negative");
  EXPECT_EQ(refusal([](auto& o) { o.max_range = kNaN; }), "max_range = nan: must not be negative");
  EXPECT_EQ(refusal([](auto& o) { o.visibility.tolerance = -0.1; }), "tolerance = -0.1: must not be negative");
  EXPECT_EQ(refusal([](auto& o) { o.visibility.clearance = kNaN; }), "clearance = nan: must not be negative");
  EXPECT_EQ(refusal([](auto& o) { o.no_return_is_free = 0.0; }), "no_return_is_free = 0: must be positive and finite");
  EXPECT_EQ(refusal([](auto& o) {
              o.projection = SphericalProjection{{0.0, 1.0}, 0};
            }),
            "columns = 0: must be at least 1");
}

}  // namespace
}  // namespace gaussmap
