// SPDX-License-Identifier: BSD-3-Clause
// gaussmap segments as in Leal 2000, its observer and its pictures, through the real program.
#include <cmath>
#include <memory>
#include <sstream>

#include "apps/segments_fixture.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/segments/segment_fitter.h"

namespace gaussmap::test {
namespace {

/// A robot drives through a corridor from x = 0 to x = 30. The wall on its left has a step of 25 cm every 80 cm.
std::string steppedLog() {
  const auto isFree = [](double x, double y) {
    return x > -3.0 && x < 34.0 && y > -1.0 && y < (static_cast<int>(std::floor(x / 0.8)) % 2 == 0 ? 1.5 : 1.25);
  };
  std::ostringstream text;
  for (int scan = 0; scan <= 75; ++scan) {
    const double x = 0.4 * scan, heading = scan % 2 == 0 ? 0.0 : kPi;
    text << "FLASER 180";
    for (int i = 0; i < 180; ++i) {
      const double bearing = heading + (i - 90) * kPi / 180.0;
      double range = 0.0;
      while (isFree(x + range * std::cos(bearing), range * std::sin(bearing))) range += 0.005;
      text << ' ' << range;
    }
    text << ' ' << x << " 0 " << heading << " 0 0 0 1 host 1\n";
  }
  return text.str();
}

class SegmentsAsInPaper : public SegmentsApp {};

TEST_F(SegmentsAsInPaper, MapAsInThePaperAndOverrideSingleSettings) {
  const std::vector<std::string> scans = {"segments", world("plan/scans")};
  const auto mapWith = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = scans;
    arguments.insert(arguments.end(), {"-o", own(name)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    succeed(arguments);
    return contentsOf(own(name));
  };
  const std::string paper = mapWith("paper.pcd", {"--as-in-paper"});
  const std::vector<std::string> settings = {
      "--policy",      "particles", "--particle-limit", "segment", "--utility",          "viewpoint-invariant",
      "--association", "polygon",   "--holes",          "keep",    "--merge-candidates", "linked",
      "--ends",        "fitted",    "--no-prune"};
  EXPECT_EQ(mapWith("settings.pcd", settings), paper);
  EXPECT_NE(mapWith("default.pcd", {}), paper);
  // The C++ preset makes the same map.
  SegmentFitter fitter(SegmentFitterOptions::leal2000(), std::make_shared<ViewpointInvariantUtility>());
  for (const LaserScan& scan : planarScans(findScans({world("plan/scans")}).scans)) fitter.add(scan);
  saveSegmentsPcd(own("cpp.pcd"), fitter.map());
  EXPECT_EQ(contentsOf(own("cpp.pcd")), paper);
  // Each option overrides its setting, in any order.
  std::size_t number = 0;
  for (const std::vector<std::string>& option : std::vector<std::vector<std::string>>{
           {"--policy", "moments"},
           {"--particle-limit", "bins"},
           {"--utility", "description-length"},
           {"--association", "surface"},
           {"--holes", "split"},
           {"--merge-candidates", "near"},
           {"--ends", "adjusted"},
           {"--particles", "10"},
           {"--per-metre", "50"},
           {"--l-min", "2"},
           {"--sigma", "0.03"},
           {"--range-noise", "0.05"},
       }) {
    SCOPED_TRACE(option[0]);
    std::vector<std::string> more = option;
    more.insert(number % 2 == 0 ? more.begin() : more.end(), "--as-in-paper");
    EXPECT_NE(mapWith(std::to_string(number++) + ".pcd", more), paper);
  }
  const Json json = jsonOf({world("plan/scans"), "-o", own("json.pcd"), "--as-in-paper"});
  EXPECT_EQ(json["as_in_paper"], true);
  EXPECT_FALSE(jsonOf({world("plan/scans"), "-o", own("j.pcd")}).contains("as_in_paper"));
}

TEST_F(SegmentsAsInPaper, LetAnObserverWalkThroughTheFinishedMap) {
  const std::string log = directory_.write("steps.log", steppedLog());
  const auto walk = [&](const std::string& name, const std::string& positions) {
    return jsonOf({log, "--utility", "viewpoint-dependent", "--sigma", "0.04", "--l-min", "3", "--view-radius", "4",
                   "--view-scale", "0.2", "-o", own(name + ".pcd"), "-o", own(name + ".svg"), "--stats",
                   own(name + ".csv"), "--observer-path", directory_.write(name + ".txt", positions)});
  };
  const auto near = [&](const std::string& name, const Vector<2>& place) {
    std::size_t count = 0;
    for (const Segment& segment : loadSegmentsPcd(own(name + ".pcd")).segments) count += segment.distance(place) < 4.0;
    return count;
  };
  const Vector<2> west(8.0, 0.0), east(24.0, 0.0);
  const Json in_west = walk("west", "# x y\n24 0\n1e4 0\n8 0\n"), in_east = walk("east", "8,0\n24 0 # end\n");
  EXPECT_EQ(in_west["observer"]["positions"], 3);
  EXPECT_GT(in_west["observer"]["splits"], 0);
  EXPECT_GT(in_west["observer"]["merges"], 0);
  EXPECT_GT(near("west", west), near("east", west));
  EXPECT_LT(near("west", east), near("east", east));
  // One line per scan and per position.
  EXPECT_EQ(linesOf(own("west.csv")), 1u + 76u + 3u);
  EXPECT_NE(contentsOf(own("west.csv")).find("\n78,\"west.txt:2\",0,"), std::string::npos);
  EXPECT_NE(contentsOf(own("west.svg")).find("<circle"), std::string::npos);
  // The same positions as poses.
  const Json poses = walk("poses", "0 8 0 1 0 0 0 1\n1 24 0 1 0 0 0 1\n");
  EXPECT_EQ(poses["observer"], in_east["observer"]);
  EXPECT_EQ(contentsOf(own("poses.pcd")), contentsOf(own("east.pcd")));
}

TEST_F(SegmentsAsInPaper, RefusePathsThatAreNotPositions) {
  const auto refuse = [&](const std::string& word, const std::string& text) {
    expectDataError(word, {"segments", world("room.log"), "-o", own("x.pcd"), "--utility", "viewpoint-dependent",
                           "--observer-path", directory_.write("path.txt", text)});
  };
  refuse("path.txt: no position", "# nothing\n");
  refuse("path.txt: line 2: 'b' is not a coordinate", "1 2\n3 b\n");
  refuse("path.txt: line 3 has 3 numbers", "1 2\n\n3 4 5\n");
  refuse("path.txt: line 1 has 1 numbers", "1\n");
  refuse("'nan'", "nan 1\n");
  refuse("path.txt", "0 1 2 3 0 0 0 9\n");  // not a unit quaternion
  expectDataError("absent.txt", {"segments", world("room.log"), "-o", own("x.pcd"), "--utility", "viewpoint-dependent",
                                 "--observer-path", own("absent.txt")});
  const std::string path = directory_.write("path.txt", "1 2\n");
  expectUsageError("--observer-path", {"segments", world("room.log"), "-o", own("x.pcd"), "--observer-path", path});
  expectUsageError("--observer-path", {"segments", world("room.log"), "-o", own("x.pcd"), "--observer-path", path,
                                       "--utility", "viewpoint-dependent", "--viewpoint", "0", "0", "1"});
  expectUsageError("input", {"segments", world("room.log"), "--stats", path, "--force", "--observer-path", path,
                             "--utility", "viewpoint-dependent"});
}

TEST_F(SegmentsAsInPaper, DrawOneObservation) {
  const Json json = jsonOf({world("room.log"), "-o", own("beam.svg"), "--observation", "2:90", "--particles", "200",
                            "--bearing-noise", "0.2"});
  EXPECT_EQ(json["scan"], 2);
  EXPECT_EQ(json["beam"], 90);
  EXPECT_NEAR(json["bearing"].get<double>(), 0.0, 1e-9);
  EXPECT_EQ(json["particles"], 200);
  EXPECT_FALSE(json.contains("segments"));
  const std::string svg = contentsOf(own("beam.svg"));
  EXPECT_EQ(svg.find("<svg "), 0u);
  EXPECT_NE(svg.find("the 200 particles"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  const std::string said =
      succeed({"segments", world("plan/scans"), "-o", own("scan.svg"), "--observation", "0:17", "--as-in-paper"});
  EXPECT_NE(said.find("scan.svg: scan00.pcd, beam 17: "), std::string::npos) << said;
  EXPECT_NE(said.find(", 30 particles\n"), std::string::npos) << said;

  const auto refuse = [&](const std::string& word, const std::string& beam, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"segments", world("room.log"), "-o", own("x.svg"), "--observation", beam};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expectUsageError(word, arguments);
  };
  refuse("no scan 30; the numbers are 0 to 29", "30:0");
  refuse("no beam 180; the numbers are 0 to 179", "0:180");
  for (const char* const wrong : {"3", ":3", "3:", "a:1", "1:-1", "1:2:3", "1:2 "}) refuse("expected SCAN:BEAM", wrong);
  refuse("--walls", "0:0", {"--walls", world("room.pcd")});
  refuse("--stats", "0:0", {"--stats", own("x.csv")});
  refuse("--evidence", "0:0", {"--evidence"});
  refuse(".svg", "0:0", {"-o", own("x.pcd")});
  expectUsageError("-o", {"segments", world("room.log"), "--observation", "0:0"});
  expectUsageError("no return", {"segments", directory_.write("far.log", "FLASER 3 1 99 1 0 0 0\n"), "-o", own("x.svg"),
                                 "--observation", "0:1"});
}

TEST_F(SegmentsAsInPaper, DrawAPartAndTheEvidenceBesideIt) {
  const auto widthOf = [](const std::string& svg) { return std::stod(svg.substr(svg.find("width='") + 7)); };
  succeed({"segments", world("room.log"), "-o", own("under.svg"), "--evidence", "--as-in-paper"});
  succeed({"segments", world("room.log"), "-o", own("beside.svg"), "--evidence-beside", "--as-in-paper"});
  const std::string under = contentsOf(own("under.svg")), beside = contentsOf(own("beside.svg"));
  EXPECT_EQ(under.find("translate("), std::string::npos);
  EXPECT_NE(beside.find("translate("), std::string::npos);
  EXPECT_EQ(std::count(beside.begin(), beside.end(), 'M'), std::count(under.begin(), under.end(), 'M'));
  succeed({"segments", world("room.pcd"), "-o", own("part.svg"), "--box", "-6", "-2", "1", "6"});
  const std::string part = contentsOf(own("part.svg"));
  EXPECT_NE(part.find("clip-path"), std::string::npos);
  EXPECT_NE(part.find("2 of 4 segments"), std::string::npos) << part;  // the walls x = -4 and y = 3
  EXPECT_NEAR(widthOf(part), 7.0 / 8.0 * 1400.0 + 32.0, 0.1);
  expectUsageError("--box", {"segments", world("room.pcd"), "-o", own("x.svg"), "--box", "0", "0", "0", "1"});
  expectUsageError("--evidence-beside", {"segments", world("room.pcd"), "-o", own("x.svg"), "--evidence-beside"});
}

}  // namespace
}  // namespace gaussmap::test
