// SPDX-License-Identifier: BSD-3-Clause
// Coordinates far from the origin, and 64-bit integers, through the real program.
#include <cmath>
#include <fstream>
#include <random>

#include "apps/app_fixture.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/pcd/pcd_records.h"

namespace gaussmap::test {
using namespace detail;

namespace {

class PrecisionApp : public AppTest {
 protected:
  /// A floor and a wall around a sensor, in its frame.
  static std::vector<Vector<3>> room(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> along(-6.0, 6.0), up(-1.0, 2.0);
    std::vector<Vector<3>> points;
    for (int i = 0; i < 400; ++i) points.emplace_back(along(random), along(random), -1.0);
    for (int i = 0; i < 200; ++i) points.emplace_back(6.5, along(random), up(random));
    return points;
  }
  static Pose poseAt(const Eigen::Vector3d& place) { return {place, Pose::Rotation::Identity()}; }

  void writeScans(const std::string& folder, const Eigen::Vector3d& place) const {
    std::filesystem::create_directories(own(folder));
    for (unsigned i = 0; i < 3; ++i) {
      const Eigen::Vector3d moved(0.25 * i, 0, 0);
      std::vector<Vector<3>> points = room(i);
      for (Vector<3>& point : points) point -= moved;
      writePcd(own(folder + "/s" + std::to_string(i) + ".pcd"), points, PcdPrecision::Float, poseAt(place + moved));
    }
  }
  /// Runs a command that succeeds with one line on stderr, and returns that line.
  static std::string warned(const std::vector<std::string>& arguments) {
    const Outcome outcome = runApp(arguments);
    EXPECT_EQ(outcome.code, 0) << testing::PrintToString(arguments) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  }
  double distanceOf(const std::string& a, const std::string& b, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"hausdorff", a, b, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Json json = Json::parse(succeed(words));
    return json.contains("scales") ? json["scales"][0]["all"]["hausdorff"].get<double>()
                                   : json["all"]["hausdorff"].get<double>();
  }
  static char typeOfX(const std::string& path) {
    return static_cast<char>('0' + PcdReader(path).header().find("x")->size);
  }

  const Eigen::Vector3d far_{690123.5, 5334567.75, 519.0};
};

TEST_F(PrecisionApp, MergedCloudsFarFromTheOriginAreDoubles) {
  writeScans("near", {3, 4, 0});
  writeScans("far", far_);
  succeed({"clean", own("near"), "--merged", own("near.pcd")});
  EXPECT_EQ(typeOfX(own("near.pcd")), '4');
  const std::string said = warned({"clean", own("far"), "--merged", own("far.pcd"), "--removed", own("gone.pcd")});
  EXPECT_NE(said.find("far.pcd: x y z are doubles"), std::string::npos) << said;
  EXPECT_EQ(typeOfX(own("far.pcd")), '8');
  EXPECT_LT(distanceOf(own("far.pcd"), own("far")), 1e-6);
  EXPECT_LT(distanceOf(own("far.pcd"), own("far"), {"--frame", "sensor"}), 1e-6);
}

TEST_F(PrecisionApp, TilesFarFromTheOriginAreDoublesAndBecomeTheMapAgain) {
  writeScans("far", far_);
  succeed({"pcd2map", own("far"), "-o", own("a.gmap"), "--resolution", "0.2"});
  const std::string said = warned({"tiles", own("a.gmap"), "-o", own("tiles"), "--size", "10"});
  EXPECT_NE(said.find("x y z are doubles"), std::string::npos) << said;
  EXPECT_NE(said.find("gaussmap transform"), std::string::npos) << said;
  succeed({"tiles", own("tiles"), "-o", own("b.gmap")});
  EXPECT_LT(distanceOf(own("b.gmap"), own("a.gmap"), {"--scale", "0"}), 1e-5);
  const std::string rounded = warned({"tiles", own("a.gmap"), "-o", own("floats"), "--floats"});
  EXPECT_NE(rounded.find("rounded by 0.25 m"), std::string::npos) << rounded;
  expectDataError("outside its cell", {"tiles", own("floats"), "-o", own("c.gmap")});
  expectUsageError("directory", {"tiles", own("a.gmap"), "-o", own("t.gmap")});
}

TEST_F(PrecisionApp, RoundedInputIsReported) {
  std::vector<Vector<3>> points = room(1);
  for (Vector<3>& point : points) point += far_;
  writePcd(own("float.pcd"), points);
  writePcd(own("double.pcd"), points, PcdPrecision::Double);
  const std::string said = warned({"pcd2map", own("float.pcd"), "-o", own("f.gmap"), "--frame", "map"});
  EXPECT_NE(said.find("float.pcd: the coordinates are rounded to steps of 0.5 m"), std::string::npos) << said;
  warned({"pcd2map", own("float.pcd"), "-o", own("g.gmap"), "--max-memory", "100M"});
  warned({"pcd2map", own("float.pcd"), "-o", own("h.gmap"), "--online"});
  succeed({"pcd2map", own("double.pcd"), "-o", own("d.gmap"), "--frame", "map"});
  succeed({"pcd2map", own("float.pcd"), "-o", own("c.gmap"), "--frame", "map", "--resolution", "8"});
}

TEST_F(PrecisionApp, MillimetresAreReported) {
  std::vector<Vector<3>> points = room(2);
  for (Vector<3>& point : points) point *= 1000.0;
  writePcd(own("mm.pcd"), points);
  const std::string said = warned({"pcd2map", own("mm.pcd"), "-o", own("m.gmap")});
  EXPECT_NE(said.find("millimetres?"), std::string::npos) << said;
  EXPECT_NE(said.find("0.001"), std::string::npos) << said;
}

TEST_F(PrecisionApp, CleanKeepsIntegersOf64Bits) {
  const std::uint64_t stamp = 1700000000123456789u;
  std::string text =
      "FIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 20\nHEIGHT 1\nVIEWPOINT 1 2 0 1 0 0 0\n"
      "POINTS 20\nDATA ascii\n";
  for (std::uint64_t i = 0; i < 20; ++i) text += "5 " + std::to_string(i) + " 1 " + std::to_string(stamp + i) + "\n";
  directory_.write("a.pcd", text);
  directory_.write("b.pcd", text);
  succeed({"clean", own("a.pcd"), own("b.pcd"), "-o", own("c"), "--merged", own("m.pcd")});
  for (const std::string& path : {own("c/a.pcd"), own("m.pcd")}) {
    const PcdRecords records = readRecords(PcdReader(path));
    ASSERT_EQ(records.size(), path == own("m.pcd") ? 40u : 20u);
    for (std::size_t i = 0; i < records.size(); ++i) {
      std::uint64_t value = 0;
      std::memcpy(&value, records.bytes.data() + i * records.record_size + records.fields[3].offset, sizeof(value));
      EXPECT_EQ(value, stamp + i % 20);
    }
  }
}

}  // namespace
}  // namespace gaussmap::test
