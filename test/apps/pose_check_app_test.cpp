// SPDX-License-Identifier: BSD-3-Clause
// Poses that mean something else than the program assumes: the commands stop and say which option to use.
#include <fstream>
#include <functional>
#include <sstream>

#include "apps/app_fixture.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

/// Eight scans of the simulated hall, created once for all tests.
class PoseCheckApp : public AppTest {
 protected:
  static void SetUpTestSuite() {
    hall_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(
        runApp({"simulate", "hall", "-o", hall("").string(), "--scans", "30", "--rings", "16", "--columns", "180"})
            .code,
        0);
    for (int i = 8; i < 30; ++i)
      fs::remove(hall("scans/scan" + std::string(i < 10 ? "0" : "") + std::to_string(i) + ".pcd"));
  }
  static void TearDownTestSuite() { hall_.reset(); }
  static fs::path hall(const std::string& name) { return hall_->path() / name; }

  /// Writes the poses of the trajectory, changed, as a TUM file, and returns its path.
  std::string poses(const std::function<std::vector<double>(const std::vector<double>&)>& change) const {
    std::ifstream in(hall("trajectory.tum"));
    std::ofstream out(own("poses.tum"));
    out.precision(12);
    std::string line;
    for (int i = 0; i < 8 && std::getline(in, line);) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream words(line);
      std::vector<double> numbers(8);
      for (double& number : numbers) words >> number;
      out << i++;
      for (const double number : change({numbers.begin() + 1, numbers.end()})) out << ' ' << number;
      out << '\n';
    }
    return own("poses.tum");
  }

  static std::unique_ptr<TemporaryDirectory> hall_;
};
std::unique_ptr<TemporaryDirectory> PoseCheckApp::hall_;

TEST_F(PoseCheckApp, AcceptsTheRightPoses) {
  succeed({"pcd2map", hall("scans"), "-o", own("a.gmap")});
  succeed({"pcd2map", hall("scans"), "-o", own("b.gmap"), "--poses", poses([](const auto& pose) { return pose; })});
  succeed({"pcd2map", hall("scans/scan00.pcd"), "-o", own("c.gmap")});
}

TEST_F(PoseCheckApp, StopsForQuaternionsWithWFirst) {
  const std::string file =
      poses([](const std::vector<double>& p) { return std::vector<double>{p[0], p[1], p[2], p[6], p[3], p[4], p[5]}; });
  expectDataError("use --pose-convention w-first, or use --no-pose-check if the poses are right",
                  {"pcd2map", hall("scans"), "-o", own("a.gmap"), "--poses", file});
  expectDataError("use --pose-convention w-first", {"clean", hall("scans"), "-o", own("clean"), "--poses", file});
  const std::string built =
      succeed({"pcd2map", hall("scans"), "-o", own("a.gmap"), "--poses", file, "--pose-convention", "w-first"});
  const std::string right = succeed({"pcd2map", hall("scans"), "-o", own("b.gmap")});
  EXPECT_EQ(built.substr(built.find(":"), built.find(" MB") - built.find(":")).substr(0, 40),
            right.substr(right.find(":"), right.find(" MB") - right.find(":")).substr(0, 40));
  succeed({"pcd2map", hall("scans"), "-o", own("c.gmap"), "--poses", file, "--no-pose-check"});
}

TEST_F(PoseCheckApp, StopsForInversePoses) {
  const std::string file = poses([](const std::vector<double>& p) {
    const Eigen::Quaterniond back = Eigen::Quaterniond(p[6], p[3], p[4], p[5]).conjugate();
    const Eigen::Vector3d t = -(back * Eigen::Vector3d(p[0], p[1], p[2]));
    return std::vector<double>{t.x(), t.y(), t.z(), back.x(), back.y(), back.z(), back.w()};
  });
  expectDataError("use --pose-convention inverse", {"pcd2map", hall("scans"), "-o", own("a.gmap"), "--poses", file});
  succeed({"pcd2map", hall("scans"), "-o", own("a.gmap"), "--poses", file, "--pose-convention", "inverse"});
}

TEST_F(PoseCheckApp, StopsForPosesOfACamera) {
  // Camera axes: x right = -y of the lidar, y down = -z, z forward = x. The same change of axes for the rotation.
  const std::string file = poses(
      [](const std::vector<double>& p) { return std::vector<double>{-p[1], -p[2], p[0], -p[4], -p[5], p[3], p[6]}; });
  expectDataError("use --pose-convention camera", {"pcd2map", hall("scans"), "-o", own("a.gmap"), "--poses", file});
  succeed({"pcd2map", hall("scans"), "-o", own("a.gmap"), "--poses", file, "--pose-convention", "camera"});
}

TEST_F(PoseCheckApp, StopsForAViewpointWithWLast) {
  fs::create_directory(own("scans"));
  for (const auto& entry : fs::directory_iterator(hall("scans"))) {
    std::ifstream in(entry.path(), std::ios::binary);
    std::ofstream out(own("scans/") + entry.path().filename().string(), std::ios::binary);
    for (std::string line; std::getline(in, line); out << line << '\n') {
      if (line.rfind("VIEWPOINT ", 0) != 0) continue;
      std::istringstream words(line.substr(10));
      std::vector<std::string> w(7);
      for (std::string& word : w) words >> word;
      line = "VIEWPOINT " + w[0] + " " + w[1] + " " + w[2] + " " + w[4] + " " + w[5] + " " + w[6] + " " + w[3];
    }
  }
  expectDataError("use --pose-convention w-last", {"pcd2map", own("scans"), "-o", own("a.gmap")});
}

TEST_F(PoseCheckApp, StopsForAWrongFrame) {
  expectDataError("run the command without --frame map, or use --no-pose-check",
                  {"pcd2map", hall("scans"), "-o", own("a.gmap"), "--frame", "map"});
  expectDataError("run the command without --frame map and --pose-convention, or use --no-pose-check",
                  {"pcd2map", hall("scans"), "-o", own("a.gmap"), "--frame", "map", "--pose-convention", "inverse"});
  fs::create_directory(own("moved"));
  const FileScans scans = findScans({hall("scans")}).scans;
  for (const FileScan& file : scans.files()) {
    const Scan scan = FileScans({file}).read(0);
    std::vector<Vector<3>> points;
    for (const Eigen::Vector3d& point : scan.points) points.emplace_back(scan.pose * point);
    writePcd(own("moved/") + file.path.filename().string(), points, PcdPrecision::Float, scan.pose);
  }
  expectDataError("use --frame map", {"pcd2map", own("moved"), "-o", own("b.gmap")});
  succeed({"pcd2map", own("moved"), "-o", own("b.gmap"), "--frame", "map"});
}

}  // namespace
}  // namespace gaussmap::test
