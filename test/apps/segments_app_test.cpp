// SPDX-License-Identifier: BSD-3-Clause
// gaussmap segments through the real program.
#include <cmath>
#include <sstream>

#include "apps/segments_fixture.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/logs/gzip.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

TEST_F(SegmentsApp, MapTheFourWallsOfARoom) {
  const SegmentMap map = loadSegmentsPcd(world("room.pcd"));
  ASSERT_EQ(map.segments.size(), 4u);
  EXPECT_NEAR(map.totalLength(), 28.0, 0.2);
  for (const Segment& segment : map.segments) {
    EXPECT_GT(segment.normal().dot(-segment.start), 0.0);  // free space, the middle of the room, on the left
    EXPECT_NEAR(std::abs(std::abs(segment.direction().x()) - 0.5), 0.5, 1e-3);
    for (const Vector<2>& corner : {segment.start, segment.end})
      EXPECT_NEAR((corner.cwiseAbs() - Vector<2>(4, 3)).norm(), 0.0, 0.02);
  }
  EXPECT_EQ(map.chains.size(), 1u);
}

TEST_F(SegmentsApp, WriteTheSameMapInEveryFormat) {
  const std::string said = succeed({"segments", world("room.log"), "-o", own("a.pcd"), "-o", own("a.csv"), "-o",
                                    own("a.geojson"), "-o", own("a.svg")});
  EXPECT_NE(said.find("a.svg: 4 segments in 1 chains, 2"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
  EXPECT_EQ(contentsOf(own("a.pcd")), contentsOf(world("room.pcd")));
  EXPECT_EQ(linesOf(own("a.csv")), 5u);
  const Json features = Json::parse(contentsOf(own("a.geojson")))["features"];
  ASSERT_EQ(features.size(), 4u);
  const SegmentMap map = loadSegmentsPcd(own("a.pcd"));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(features[i]["geometry"]["coordinates"][0][0].get<double>(), map.segments[i].start.x());
    EXPECT_EQ(features[i]["geometry"]["coordinates"][1][1].get<double>(), map.segments[i].end.y());
    EXPECT_EQ(features[i]["properties"]["weight"].get<double>(), map.segments[i].weight);
  }
  const std::string svg = contentsOf(own("a.svg"));
  EXPECT_EQ(svg.find("<svg "), 0u);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_NE(svg.find("4 segments in 1 chains"), std::string::npos);
  // A finished map is an input too, and becomes the same files.
  succeed({"segments", own("a.pcd"), "-o", own("b.csv"), "-o", own("b.geojson"), "-o", own("b.svg")});
  for (const char* const extension : {".csv", ".geojson", ".svg"})
    EXPECT_EQ(contentsOf(own(std::string("a") + extension)), contentsOf(own(std::string("b") + extension)));
}

TEST_F(SegmentsApp, DrawEvidenceAndTheViewpointOnDemand) {
  succeed({"segments", world("room.log"), "-o", own("plain.svg")});
  succeed({"segments", world("room.log"), "-o", own("more.svg"), "--evidence", "--utility", "viewpoint-dependent",
           "--viewpoint", "1", "1", "2"});
  const std::string plain = contentsOf(own("plain.svg")), more = contentsOf(own("more.svg"));
  EXPECT_EQ(plain.find("<circle"), std::string::npos);
  EXPECT_NE(more.find("<circle"), std::string::npos);
  succeed({"segments", world("room.log"), "-o", own("moving.svg"), "--utility", "viewpoint-dependent", "--view-radius",
           "3"});
  EXPECT_NE(contentsOf(own("moving.svg")).find("<circle"), std::string::npos);  // round the last place of the sensor
  EXPECT_GT(std::count(more.begin(), more.end(), 'M'), 200 + std::count(plain.begin(), plain.end(), 'M'));
}

TEST_F(SegmentsApp, SayWhatEachScanDid) {
  succeed({"segments", world("room.log"), "--stats", own("stats.csv"), "--every", "3"});
  std::istringstream table(contentsOf(own("stats.csv")));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "scan,file,beams,associated,created,splits,merges,pruned,segments,normal_variance,coverage");
  for (int scan = 0; scan < 30; scan += 3) {
    ASSERT_TRUE(std::getline(table, line));
    EXPECT_EQ(line.find(std::to_string(scan) + ",\"room.log:" + std::to_string(scan) + "\",180,"), 0u) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 10) << line;
  }
  EXPECT_FALSE(std::getline(table, line));
}

TEST_F(SegmentsApp, ScoreTheScansThatAreNotInTheMap) {
  const Json left_out = jsonOf({world("room.log"), "--every", "2", "--evaluate", world("room.log")});
  EXPECT_EQ(left_out["scans"], 15);
  EXPECT_EQ(left_out["held_out"]["scans"], 15);
  EXPECT_EQ(left_out["held_out"]["beams"], 15 * 180);
  EXPECT_EQ(left_out["held_out"]["cov5"], 1.0);
  EXPECT_EQ(left_out["held_out"]["r10"], 1.0);
  EXPECT_EQ(left_out["held_out"]["viol"], 0.0);
  EXPECT_LT(left_out["held_out"]["rms"].get<double>(), 0.01);
  // The finished map, on another log; with every wall 30 cm nearer nothing fits.
  const Json finished = jsonOf({world("room.pcd"), "--evaluate", directory_.write("other.log", roomLog(7))});
  EXPECT_EQ(finished["held_out"]["beams"], 7 * 180);
  EXPECT_EQ(finished["held_out"]["cov5"], 1.0);
  SegmentMap small = loadSegmentsPcd(world("room.pcd"));
  for (Segment& segment : small.segments)
    for (Vector<2>* const point : {&segment.start, &segment.end})
      *point -= Vector<2>(std::copysign(0.3, point->x()), std::copysign(0.3, point->y()));
  saveSegmentsPcd(own("small.pcd"), small);
  const Json wrong = jsonOf({own("small.pcd"), "--evaluate", own("other.log")});
  EXPECT_LT(wrong["held_out"]["cov10"].get<double>(), 0.05);
  EXPECT_GT(wrong["held_out"]["viol"].get<double>(), 0.95);
}

TEST_F(SegmentsApp, FindTheWallsOfTheSimulatedPlan) {
  const Json json = jsonOf({world("plan/scans"), "-o", own("plan.pcd"), "--walls", world("plan/walls.pcd"), "--every",
                            "2", "--evaluate", world("plan/scans")});
  EXPECT_EQ(json["scans"], 40);
  EXPECT_GT(json["walls"]["recall"].get<double>(), 0.8);
  EXPECT_GT(json["walls"]["precision"].get<double>(), 0.95);
  EXPECT_GT(json["walls"]["matched"], 20);
  EXPECT_LT(json["walls"]["offset_rms"].get<double>(), 0.01);
  EXPECT_EQ(json["held_out"]["scans"], 40);
  EXPECT_GT(json["held_out"]["cov10"].get<double>(), 0.9);
  const std::string said = succeed({"segments", own("plan.pcd"), "--walls", world("plan/walls.pcd")});
  EXPECT_NE(said.find("\nwalls: recall "), std::string::npos) << said;
}

TEST_F(SegmentsApp, ReadLogsAndPcdScansAlike) {
  fs::create_directory(own("scans"));
  std::istringstream log(roomLog(12));
  std::string word;
  for (int scan = 0; log >> word;) {
    if (word != "FLASER") continue;
    std::size_t n = 0;
    log >> n;
    std::vector<double> ranges(n);
    for (double& range : ranges) log >> range;
    double x = 0.0, y = 0.0, heading = 0.0;
    log >> x >> y >> heading;
    std::vector<Vector<3>> points;
    for (std::size_t i = 0; i < n; ++i) {
      const double bearing = (static_cast<double>(i) - 90.0) * kPi / 180.0;
      points.emplace_back(ranges[i] * std::cos(bearing), ranges[i] * std::sin(bearing), 0.0);
    }
    writePcd(own("scans/scan" + std::to_string(10 + scan++) + ".pcd"), points, PcdPrecision::Double,
             Pose{{x, y, 0.2}, Pose::Rotation(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()))});
  }
  succeed({"segments", own("scans"), "-o", own("pcd.pcd")});
  succeed({"segments", directory_.write("room.log", roomLog(12)), "-o", own("log.pcd")});
  const SegmentMap a = loadSegmentsPcd(own("pcd.pcd")), b = loadSegmentsPcd(own("log.pcd"));
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    EXPECT_NEAR((a.segments[i].start - b.segments[i].start).norm(), 0.0, 1e-3);
    EXPECT_NEAR((a.segments[i].end - b.segments[i].end).norm(), 0.0, 1e-3);
  }
}

TEST_F(SegmentsApp, SliceThreeDimensionalScans) {
  succeed({"simulate", "corner", "-o", own("corner"), "--rings", "24", "--columns", "720"});
  expectDataError("slice", {"segments", own("corner/scans"), "-o", own("x.svg")});
  // The corner: walls of 20 m and 12 m along the floor and a pole; above the floor, below the tops.
  succeed({"segments", own("corner/scans"), "-o", own("walls.pcd"), "--slice", "0.5", "3.5"});
  double longest = 0.0;
  for (const Segment& segment : loadSegmentsPcd(own("walls.pcd")).segments)
    longest = std::max(longest, segment.length());
  EXPECT_GT(longest, 8.0);
  EXPECT_LT(longest, 20.2);
  expectDataError("no beam", {"segments", own("corner/scans"), "-o", own("x.svg"), "--slice", "50", "60"});
  expectUsageError("second height", {"segments", own("corner/scans"), "-o", own("x.svg"), "--slice", "2", "1"});
}

TEST_F(SegmentsApp, KeepWhatComesBeforeTheDamageOfALog) {
  const std::string text = roomLog(40), packed = gzipped(text);
  const Outcome half =
      runApp({"segments", directory_.write("half.log.gz", packed.substr(0, packed.size() / 2)), "-o", own("half.pcd")});
  EXPECT_EQ(half.code, 0);
  EXPECT_NE(half.err.find("half.log.gz: line "), std::string::npos) << half.err;
  EXPECT_NE(half.err.find("cut off"), std::string::npos) << half.err;
  EXPECT_EQ(loadSegmentsPcd(own("half.pcd")).segments.size(), 4u);

  const std::string bad = "FLASER 3 1 2\nFLASER 2 1 2 nan 0 0\n";
  const Outcome damaged = runApp({"segments", directory_.write("bad.log", bad + roomLog(30)), "-o", own("bad.pcd")});
  EXPECT_EQ(damaged.code, 0);
  EXPECT_NE(damaged.err.find("bad.log: line 1 is left out: "), std::string::npos) << damaged.err;
  EXPECT_NE(damaged.err.find("bad.log: line 2 is left out: the x of the pose is not finite"), std::string::npos);
  EXPECT_EQ(contentsOf(own("bad.pcd")), contentsOf(world("room.pcd")));  // nothing lost of the rest

  std::string many = roomLog(3);
  for (int i = 0; i < 100; ++i) many += "FLASER\n";
  const Outcome warned = runApp({"segments", directory_.write("many.log", many), "-o", own("many.pcd")});
  EXPECT_EQ(warned.code, 0);
  EXPECT_EQ(std::count(warned.err.begin(), warned.err.end(), '\n'), 6) << warned.err;
  EXPECT_NE(warned.err.find("95 more"), std::string::npos) << warned.err;
}

TEST_F(SegmentsApp, RefuseLogsWithoutAnythingToMap) {
  const auto expectRefused = [&](const std::string& word, const std::string& bytes) {
    expectDataError(word, {"segments", directory_.write("a.log", bytes), "-o", own("x.svg"), "-o", own("x.pcd")});
  };
  expectRefused("no usable scan", "");
  expectRefused("no usable scan", "ODOM 0 0 0 0 0 0 0.1 host 0.1\n");
  expectRefused("line 1", "FLASER 2 1 2 nan 0 0\n");
  expectRefused("no usable scan", gzipped(roomLog(3)).substr(0, 20));
  expectRefused("no beam", "FLASER 4 0 inf nan 81.9 0 0 0\n");
  expectDataError("none: ", {"segments", own("none"), "-o", own("x.svg")});
}

TEST_F(SegmentsApp, MapOneBeamAndBeamsOfOneRange) {
  succeed(
      {"segments", directory_.write("one.log", "FLASER 1 2.5 0 0 0\n"), "-o", own("one.svg"), "-o", own("one.csv")});
  EXPECT_LE(linesOf(own("one.csv")), 2u);
  std::string circle = "FLASER 360";
  for (int i = 0; i < 360; ++i) circle += " 3";
  succeed({"segments", directory_.write("circle.log", circle + " 0 0 0\n"), "-o", own("circle.pcd")});
  for (const Segment& segment : loadSegmentsPcd(own("circle.pcd")).segments)
    for (const Vector<2>& point : {segment.start, segment.end}) EXPECT_NEAR(point.norm(), 3.0, 0.2);
  // A number of equal scans changes nothing about that.
  std::string many;
  for (int i = 0; i < 20; ++i) many += circle + " 0 0 0\n";
  succeed({"segments", directory_.write("circles.log", many), "-o", own("circles.pcd")});
}

TEST_F(SegmentsApp, GiveTheSameBytesForTheSameSeed) {
  const auto mapWith = [&](const std::string& name, const std::string& seed) {
    succeed({"segments", world("plan/scans"), "-o", own(name), "--policy", "particles", "--seed", seed});
    return contentsOf(own(name));
  };
  const std::string first = mapWith("a.pcd", "1");
  EXPECT_EQ(mapWith("b.pcd", "1"), first);
  EXPECT_NE(mapWith("c.pcd", "2"), first);
}

TEST_F(SegmentsApp, SplitLessWithALongerLeastLength) {
  const auto splits = [&](const std::string& length) {
    return jsonOf({world("plan/scans"), "--stats", own(length + ".csv"), "--utility", "viewpoint-invariant", "--l-min",
                   length})["splits"]
        .get<int>();
  };
  EXPECT_GT(splits("0.5"), 0);
  EXPECT_EQ(splits("50"), 0);
}

TEST_F(SegmentsApp, RefuseOptionsThatDoNotGoTogether) {
  const std::string log = world("room.log"), out = own("x.svg");
  expectUsageError("nothing to do", {"segments", log});
  expectUsageError("must end in", {"segments", log, "-o", own("x.gmap")});
  expectUsageError("must end in", {"segments", log, "-o", own("x")});
  expectUsageError("another output", {"segments", log, "-o", out, "-o", out});
  expectUsageError("another output", {"segments", log, "-o", own("x.csv"), "--stats", own("x.csv")});
  expectUsageError("all scans are in the map", {"segments", log, "-o", out, "--evaluate", log});
  expectUsageError("mixed", {"segments", log, world("plan/scans"), "-o", out});
  expectUsageError("--slice", {"segments", log, "-o", out, "--slice", "0", "1"});
  expectUsageError("--l-min", {"segments", log, "-o", out, "--l-min", "1"});
  expectUsageError("--viewpoint", {"segments", log, "-o", out, "--viewpoint", "0", "0", "5"});
  expectUsageError("radius",
                   {"segments", log, "-o", out, "--utility", "viewpoint-dependent", "--viewpoint", "0", "0", "0"});
  expectUsageError("--viewpoint",
                   {"segments", log, "-o", out, "--utility", "viewpoint-dependent", "--viewpoint", "0", "0"});
  expectUsageError("--segment-cost",
                   {"segments", log, "-o", out, "--utility", "viewpoint-invariant", "--segment-cost", "3"});
  expectUsageError("--merge-ratio", {"segments", log, "-o", out, "--merge-ratio", ".5"});
  expectUsageError("finished map", {"segments", world("room.pcd"), "-o", out, "--policy", "particles"});
  expectUsageError("finished map", {"segments", world("room.pcd"), "-o", out, "--evidence"});
  expectUsageError("finished map", {"segments", world("room.pcd"), "-o", out, "--every", "2"});
  for (const char* const value : {"nan", "0", "-1", "x"})
    expectUsageError("--l-min", {"segments", log, "-o", out, "--utility", "viewpoint-invariant", "--l-min", value});
  expectUsageError("--utility", {"segments", log, "-o", out, "--utility", "best"});
  expectUsageError("--policy", {"segments", log, "-o", out, "--policy", "none"});
  expectUsageError("--every", {"segments", log, "-o", out, "--every", "0"});
}

TEST_F(SegmentsApp, NeverWriteOverAnInput) {
  fs::copy_file(world("room.log"), own("room.log"));
  fs::copy_file(world("room.pcd"), own("room.pcd"));
  fs::copy_file(world("plan/scans/scan00.pcd"), own("scan.pcd"));
  for (const std::string name : {"room.pcd", "scan.pcd"}) {
    const std::string before = contentsOf(own(name));
    expectUsageError("input", {"segments", own(name), "-o", own(name), "--force"});
    EXPECT_EQ(contentsOf(own(name)), before);
  }
  fs::create_directory(own("scans"));
  fs::copy_file(own("scan.pcd"), own("scans/scan.pcd"));
  expectUsageError("input", {"segments", own("scans"), "-o", own("scans/scan.pcd"), "--force"});
  expectUsageError("input",
                   {"segments", own("room.log"), "-o", own("scans/scan.pcd"), "--evaluate", own("scans"), "--force"});
  expectUsageError("input", {"segments", own("room.log"), "--stats", own("room.log"), "--force"});
  expectUsageError("input",
                   {"segments", own("room.log"), "-o", own("room.pcd"), "--walls", own("room.pcd"), "--force"});
  expectUsageError("--force", {"segments", own("room.log"), "-o", own("room.pcd")});
}

}  // namespace
}  // namespace gaussmap::test
