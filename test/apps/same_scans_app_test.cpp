// SPDX-License-Identifier: BSD-3-Clause
// The same scans in every format, written by independent programs (test/data/formats/same_scans/make.py), give the same
// map.
#include <cmath>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "io/files/file_contents.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

using Words = std::vector<std::string>;

std::string dataFile(const std::string& name) {
  return GAUSSMAP_TEST_DATA "/formats/same_scans/" + name;
}

/// One way to read the scans.
struct Format {
  std::string input;
  Words options = {};
};

std::vector<Format> exactFormats() {
  const std::string tum = dataFile("poses.tum"), kitti = dataFile("poses_kitti.txt");
  return {{"bin", {"--poses", kitti}},
          {"bin", {"--poses", tum, "--match-poses", "order"}},
          {"ply", {"--poses", tum, "--match-poses", "order"}},
          {"scans.e57"},
          {"none.mcap"},
          {"lz4.mcap"},
          {"zstd.mcap"},
          {"rosbag2"},
          {"rosbag2/rosbag2_0.db3"},
          {"scans.bag"}};
}

Format lasFormat(const std::string& input) {
  return {input, {"--poses", dataFile("poses.tum"), "--match-poses", "order", "--frame", "sensor"}};
}

class SameScansApp : public AppTest {
 protected:
  /// Builds a map of 960 points and returns its file.
  std::string build(const Format& format, const Words& options) const {
    const std::string map = own("map" + std::to_string(built_++) + ".gmap");
    Words words = {"pcd2map", dataFile(format.input), "-o", map, "--no-curves"};
    words.insert(words.end(), format.options.begin(), format.options.end());
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_NE(succeed(words).find(": 6 scans, 960 points"), std::string::npos);
    return map;
  }

  void expectSameFiles(const Words& options) const {
    const std::string expected = build({"pcd"}, options);
    for (const Format& format : exactFormats()) {
      SCOPED_TRACE(format.input + " " + testing::PrintToString(format.options));
      const std::string map = build(format, options);
      EXPECT_TRUE(contentsOf(map) == contentsOf(expected));
      expectSameMap<3>(load(map), load(expected));
    }
  }

 private:
  mutable int built_ = 0;
};

TEST_F(SameScansApp, OfEveryFormatGiveTheSameFile) {
  expectSameFiles({});
}

TEST_F(SameScansApp, GiveTheSameOccupancy) {
  expectSameFiles({"--online", "--resolution", "0.5"});
}

TEST_F(SameScansApp, OfLazGiveTheFileOfLas) {
  EXPECT_TRUE(contentsOf(build(lasFormat("laz"), {})) == contentsOf(build(lasFormat("las"), {})));
}

// Coordinates in LAS are rounded to 1 mm. A point moves by at most half of this along each axis of the sensor, and by
// half a step of its cell along each axis of the map, in both maps. No point moves to another cell.
TEST_F(SameScansApp, OfLasDifferByTheRoundingOfPoints) {
  const Words options = {"--resolution", "0.5", "--budget", "1"};  // several points and one Gaussian per cell
  const GaussianMapOctree exact = load(build({"pcd"}, options)), las = load(build(lasFormat("las"), options));
  const double side = 0.5, moved = std::sqrt(3.0) * (0.0005 + side / static_cast<double>(kStepsPerCell));
  double largest = 0.0;
  for (int s = 0; s < exact.scales(); ++s) {
    ASSERT_EQ(las.scale(s).keys, exact.scale(s).keys);
    for (std::size_t i = 0; i < exact.gaussianCount(s); ++i) {
      const Gaussian<3> a = exact.localGaussian(i, s), b = las.localGaussian(i, s);
      EXPECT_EQ(a.weight, b.weight);
      EXPECT_LE((a.mean - b.mean).norm(), moved);
      // The covariance is the mean of r r' over the points, where r is a point minus the mean of its cell. The root
      // mean square of r is sqrt(trace), and that of its change is at most `moved`.
      EXPECT_LE((a.cov - b.cov).norm(), 2 * std::sqrt(a.cov.trace()) * moved + moved * moved);
      largest = std::max(largest, (a.mean - b.mean).norm());
    }
  }
  EXPECT_GT(largest, 0.0002);  // the coordinates were rounded
}

}  // namespace
}  // namespace gaussmap::test
