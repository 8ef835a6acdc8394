// SPDX-License-Identifier: BSD-3-Clause
// Bad data: exit code 1.
#include <limits>

#include "apps/app_fixture.h"
#include "gaussmap/io/pcd/pcd_writer.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

TEST_F(Apps, NameTheInputThatIsMissing) {
  expectDataError(own("no.pcd") + ": ", {"pcd2map", own("no.pcd"), "-o", own("x.gmap")});
  expectDataError(own("no.pcd") + ": ", {"pcd2map", scene("scans"), own("no.pcd"), "-o", own("x.gmap")});
  expectDataError(own("no.gmap") + ": ", {"info", own("no.gmap")});
  expectDataError(own("no.gmap") + ": ", {"refine", own("no.gmap"), "-o", own("x.gmap")});
  expectDataError(own("no.gmap") + ": ", {"export", own("no.gmap"), own("x.pcd")});
  expectDataError(own("no.gmap") + ": ", {"hausdorff", own("no.gmap"), scene("truth.pcd")});
  expectDataError(own("no.pcd") + ": ", {"hausdorff", scene("map.gmap"), own("no.pcd")});
  expectDataError(own("no.txt") + ": ", {"pcd2map", scene("scans"), "-o", own("x.gmap"), "--poses", own("no.txt")});
}

TEST_F(Apps, NameTheDirectoryThatIsEmpty) {
  fs::create_directory(own("empty"));
  expectDataError(own("empty") + ": ", {"pcd2map", own("empty"), "-o", own("x.gmap")});
  expectDataError(own("empty") + ": ", {"info", own("empty")});
}

TEST_F(Apps, NameTheScanThatIsDamaged) {
  fs::copy(scene("scans"), own("scans"));
  const std::string bytes = contentsOf(own("scans/scan02.pcd"));
  for (const std::string& damaged : {bytes.substr(0, bytes.size() / 2), std::string(), std::string("hello\n")}) {
    directory_.write("scans/scan02.pcd", damaged);
    expectDataError(own("scans/scan02.pcd") + ": ", {"pcd2map", own("scans"), "-o", own("x.gmap")});
  }
  directory_.write(
      "scans/scan02.pcd",
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n"
      "1 2 three\n");
  expectDataError(own("scans/scan02.pcd") + ": line 10", {"pcd2map", own("scans"), "-o", own("x.gmap")});
  directory_.write(
      "scans/scan02.pcd",
      "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n"
      "1 2 1e12\n");
  expectDataError(own("scans/scan02.pcd") + ": ", {"pcd2map", own("scans"), "-o", own("x.gmap")});
  directory_.write(
      "scans/scan02.pcd",
      "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 0 0 0 0\n"
      "POINTS 1\nDATA ascii\n1 2 3\n");
  expectDataError(own("scans/scan02.pcd") + ": ", {"pcd2map", own("scans"), "-o", own("x.gmap")});
}

TEST_F(Apps, NameTheMapThatIsDamaged) {
  std::string bytes = contentsOf(scene("map.gmap"));
  for (std::size_t i = bytes.size() / 3; i < bytes.size(); i += 64) bytes[i] = static_cast<char>(~bytes[i]);
  const std::string cloud_bytes = contentsOf(scene("map.pcd"));
  for (const std::string& map :
       {directory_.write("flipped.gmap", bytes).string(), directory_.write("cut.gmap", bytes.substr(0, 5000)).string(),
        directory_.write("empty.gmap", "").string(), directory_.write("text.gmap", "hello").string(),
        directory_.write("cut.pcd", cloud_bytes.substr(0, cloud_bytes.size() - 9)).string(),
        scene("truth.pcd").string()}) {
    expectDataError(map + ": ", {"info", map});
    expectDataError(map + ": ", {"refine", map, "-o", own("x.gmap")});
    expectDataError(map + ": ", {"export", map, own("x.pcd")});
  }
  expectDataError(own("flipped.gmap") + ": ", {"hausdorff", own("flipped.gmap"), scene("truth.pcd")});
}

TEST_F(Apps, TakeNoMapForAScan) {
  expectDataError("Gaussians of a map", {"pcd2map", scene("map.pcd"), "-o", own("x.gmap")});
  expectDataError(scene("map.gmap").string() + ": ", {"pcd2map", scene("map.gmap"), "-o", own("x.gmap")});
}

TEST_F(Apps, NameThePoseFileThatDoesNotFit) {
  for (const char* const poses : {"0 0 0 0 0 0 0 1\n", "", "1 2 3\n", "hello\n"}) {
    directory_.write("poses.txt", poses);
    expectDataError(own("poses.txt") + ": ",
                    {"pcd2map", scene("scans"), "-o", own("x.gmap"), "--poses", own("poses.txt")});
  }
}

TEST_F(Apps, NameTheScanWithoutAUsablePoint) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  writePcd(own("nan.pcd"), {{nan, 1, 2}, {0, nan, 0}});
  writePcd(own("none.pcd"), std::vector<Vector<3>>{});
  for (const char* const name : {"nan.pcd", "none.pcd"}) {
    expectDataError(own(name) + ": ", {"pcd2map", own(name), "-o", own("x.gmap")});
    expectDataError(own(name) + ": ", {"hausdorff", scene("map.gmap"), own(name)});
    expectDataError(own(name) + ": ", {"hausdorff", own(name), scene("truth.pcd")});
  }
  fs::copy_file(own("nan.pcd"), own("again.pcd"));
  expectDataError(own("nan.pcd") + " and 1 more: ", {"pcd2map", own("nan.pcd"), own("again.pcd"), "-o", own("x.gmap")});
}

TEST_F(Apps, SayThatTheirOutputGoesNowhere) {
  const Outcome outcome = runApp({"info", scene("map.gmap")}, "/dev/full");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace gaussmap::test
