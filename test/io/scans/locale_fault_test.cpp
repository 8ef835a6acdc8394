// SPDX-License-Identifier: BSD-3-Clause
// The library within a program that speaks German: 0,5 for a half, 1.000 for a thousand.
#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <locale>
#include <map>
#include <sstream>

#include "gaussmap/io/export/map_export.h"
#include "gaussmap/io/export/map_tiles.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/logs/carmen_log.h"
#include "gaussmap/io/mesh/ply.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/pose_file.h"
#include "gaussmap/mapping/build.h"
#include "io/files/file_contents.h"
#include "io/files/temporary_directory.h"
#include "io/gmap/map_equality.h"
#include "map/random_clouds.h"
#include "simulation/trajectory.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

struct GermanNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// For C++ streams, and for C where the machine can make such a locale, as long as it lives.
class German {
 public:
  German() : before_(std::locale::global(std::locale(std::locale::classic(), new GermanNumbers))) {
    const std::string target = locales_.path() / "de_DE.UTF-8";
    if (std::system(("localedef -i de_DE -f UTF-8 '" + target + "' > /dev/null 2>&1").c_str()) != 0) return;
    ::setenv("LOCPATH", locales_.path().c_str(), 1);
    speaks_c = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  }
  ~German() {
    std::setlocale(LC_ALL, "C");
    ::unsetenv("LOCPATH");
    std::locale::global(before_);
  }
  German(const German&) = delete;
  German& operator=(const German&) = delete;
  bool speaks_c = false;

 private:
  TemporaryDirectory locales_;
  std::locale before_;
};

const std::vector<Vector<3>> kPoints = randomCloud<3>(3000, 41);

SegmentMap segments() {
  SegmentMap map;
  for (int i = 0; i < 2000; ++i) {
    Segment segment;
    segment.start = Vector<2>(1234.5 + i, 0.1);
    segment.end = Vector<2>(1235.5 + i, 0.2);
    segment.normal_variance = 1e-4;
    segment.covariance << 1.5e-4, 1e-7, 1e-7, 2.5e-4;
    segment.weight = 12345.25;
    map.segments.push_back(segment);
  }
  map.chains.push_back({0, map.segments.size(), false});
  return map;
}

/// Every kind of file that the library writes, by name.
std::map<std::string, std::string> writeAll() {
  const TemporaryDirectory directory;
  const fs::path folder = directory.path();
  const GaussianMapOctree map = build<3>(kPoints, {0.05, 4, 3, 0.0});
  save(folder / "map.gmap", map, {{"note", "1,5"}});
  writePcd(folder / "points.pcd", kPoints, PcdPrecision::Double);
  saveRecordsPcd(folder / "map.pcd", toRecords(map));
  saveCsv(folder / "map.csv", map);
  saveVtp(folder / "map.vtp", map);
  saveTiles(folder / "tiles", map);
  saveSegmentsPcd(folder / "segments.pcd", segments());
  saveSegmentsCsv(folder / "segments.csv", segments());
  saveSegmentsGeoJson(folder / "segments.geojson", segments());
  writePly(folder / "mesh.ply", {{{0, 0, 0}, {1.5, 0, 0}, {0, 1234.5, 0}}, {{0, 1, 2}}});
  Pose pose;
  pose.translation = {1234.5, 0.25, -0.5};
  writeTum(folder / "poses.tum", {{1234567.125, pose}, {1234568.5, pose}});
  EXPECT_TRUE(sameMap<3>(load(folder / "map.gmap"), map));
  EXPECT_EQ(loadTiles(folder / "tiles").gaussianCount(0), map.gaussianCount(0));
  EXPECT_EQ(PcdReader(folder / "points.pcd").size(), kPoints.size());
  EXPECT_EQ(readPly(folder / "mesh.ply").vertices[2].y(), 1234.5);
  EXPECT_EQ(readPoseFile(folder / "poses.tum").entries[1].pose->translation.x(), 1234.5);
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder)] = contentsOf(entry.path());
  return files;
}

TEST(Locale, DoesNotChangeWhatIsWritten) {
  const std::map<std::string, std::string> usual = writeAll();
  const German german;
  std::ostringstream text;
  text << 1234.5;
  ASSERT_EQ(text.str(), "1.234,5");  // else the test has proven nothing
  if (german.speaks_c) {
    ASSERT_EQ(std::to_string(0.5), "0,500000");
  }
  const std::map<std::string, std::string> foreign = writeAll();
  ASSERT_EQ(usual.size(), foreign.size());
  for (const auto& [name, bytes] : usual) EXPECT_TRUE(foreign.at(name) == bytes) << name;
  EXPECT_GT(usual.size(), 12u);
}

TEST(Locale, DoesNotChangeWhatIsRead) {
  const TemporaryDirectory directory;
  const fs::path cloud = directory.write("a.pcd",
                                         "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 1\nHEIGHT 1\n"
                                         "VIEWPOINT 1.5 0.25 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1234.5 -0.125 1e-3\n"),
                 poses = directory.write("poses.txt", "1 0 0 1.5 0 1 0 0.25 0 0 1 1234.5\n"),
                 log = directory.write("a.log", "FLASER 3 0.5 1.25 2.5 1.5 2.25 0.5 0 0 0 976052857.3 host 0.1\n");
  const German german;
  const PcdReader reader(cloud);
  EXPECT_EQ(reader.header().viewpoint.translation.x(), 1.5);
  PointBlock<3> block;
  reader.read(0, block);
  EXPECT_EQ(block.coordinate[0][0], 1234.5);
  EXPECT_EQ(block.coordinate[1][0], -0.125);
  EXPECT_EQ(block.coordinate[2][0], 1e-3);
  EXPECT_EQ(readPoseFile(poses).entries[0].pose->translation, Eigen::Vector3d(1.5, 0.25, 1234.5));
  const CarmenLog read = readCarmenLog(log);
  ASSERT_EQ(read.scans.size(), 1u);
  EXPECT_EQ(read.scans[0].ranges[1], 1.25);
  EXPECT_EQ(read.scans[0].pose.translation.y(), 2.25);
}

}  // namespace
}  // namespace gaussmap::test
