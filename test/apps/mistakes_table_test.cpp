// SPDX-License-Identifier: BSD-3-Clause
// The table of mistakes in docs/scans-and-poses.md: each row is tried with the real program.
#include <algorithm>
#include <cctype>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>

#include "apps/mistakes_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

/// A row of the table.
struct Row {
  const char* message;  // as in the documentation
  std::function<Words(const MistakesTable&)> command;
};

using T = MistakesTable;

std::string recording(const std::string& name) {
  return GAUSSMAP_TEST_DATA "/formats/robots/" + name;
}

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      // Poses and scans
      {"(1 s from the nearest pose, at most 500 ms)",
       [](const T& t) {
         return t.withPoses(t.timed(), t.poses([](unsigned i) { return std::to_string(1700000000 + i) + ".5"; }, 1));
       }},
      {"6 of 6 scans have no pose",
       [](const T& t) { return t.withPoses(t.timed(), t.poses([](unsigned i) { return T::number(i) + ".25"; })); }},
      {"the names of the scans have no times",
       [](const T& t) { return t.withPoses(t.scans(), t.poses([](unsigned i) { return T::number(i) + ".25"; }, 1)); }},
      {"dates in names are read as UTC",
       [](const T& t) {
         return t.withPoses(t.scans(T::poseOf, [](unsigned i) { return "20231115_00132" + std::to_string(i); }),
                            t.poses([](unsigned i) { return std::to_string(1700000000 + i) + ".0"; }));
       }},
      {"have the same time, 1700000000.5 s",
       [](const T& t) {
         return t.withPoses(
             t.scans(T::poseOf,
                     [](unsigned i) { return (i < 3 ? "a_170000000" : "b_170000000") + T::number(i % 3) + ".5"; }),
             t.poses([](unsigned i) { return std::to_string(1700000000 + i) + ".5"; }));
       }},
      {"have no number in common",
       [](const T& t) {
         return t.withPoses(t.scans(T::poseOf, [](unsigned i) { return std::string(1, char('a' + i)); }),
                            t.poses([](unsigned) { return ""; }, 1, T::kitti));
       }},
      {"so they are sorted before they are matched by order",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses([](unsigned i) { return T::number(i % 4) + "." + T::number(i); }));
       }},
      {"(no index 0; the indices of the file start at 1)",
       [](const T& t) { return t.withPoses(t.scans(), t.poses(T::number, 1)); }},
      {"its name is not in the file",
       [](const T& t) { return t.withPoses(t.scans(), t.poses([](unsigned i) { return T::number(i) + ".pcd"; }, 1)); }},
      {"5 poses for 6 scans",
       [](const T& t) {
         return t.withPoses(t.scans(T::poseOf, [](unsigned i) { return std::string(1, char('a' + i)); }),
                            t.poses(T::number, 1));
       }},
      {"has no pose (NaN)",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses(T::number, 0, [](unsigned i) {
           return i == 2 ? std::string("nan nan nan nan nan nan nan") : T::text(T::poseOf(i));
         }));
       }},
      {"outside the times of the poses",
       [](const T& t) {
         // Poses every 0.1 s until 0.3 s before the last scan, and scans every second.
         std::string lines;
         for (int k = 0; k <= 47; ++k)
           lines += std::to_string(1700000000 + (k + 5) / 10) + "." + std::to_string((k + 5) % 10) + " " +
                    T::text(T::poseOf(unsigned(k / 10))) + "\n";
         return t.build(t.timed(), {"--poses", t.write("poses.txt", lines), "--no-pose-check"});
       }},
      {"have the same time but other poses",
       [](const T& t) {
         return t.withPoses(t.timed(), t.poses([](unsigned i) { return std::to_string(1700000000 + i / 2) + ".5"; }));
       }},
      {"already has a pose in line 1",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses([](unsigned i) { return T::number(i % 5) + ".pcd"; }));
       }},
      {"Use --interpolate",
       [](const T& t) {
         return t.withPoses(t.timed(), t.poses([](unsigned i) { return std::to_string(1700000000 + i) + ".2"; }));
       }},
      {"the unit of the angles is not stated",
       [](const T& t) {
         return t.withPoses(
             t.scans(), t.poses(T::number, 0, [](unsigned i) { return T::number(i) + " 2 3 0 0 0." + T::number(i); }));
       }},
      {"the line has another layout than the lines before it",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses(T::number, 0, [](unsigned i) {
           return T::text(T::poseOf(i)) + (i == 4 ? " 7 8" : "");
         }));
       }},
      {"instead of 1: check the order of its numbers",
       [](const T& t) {
         return t.withPoses(t.scans(),
                            t.poses(T::number, 0, [](unsigned) { return std::string("1 2 3 0.5 0.5 0.5 0.1"); }));
       }},
      {"the 3 x 3 part is not a rotation",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses([](unsigned) { return ""; }, 0,
                                               [](unsigned) { return std::string("1 0 0 4 0 2 0 5 0 0 1 6"); }));
       }},
      {"is it written column by column?",
       [](const T& t) {
         return t.withPoses(t.scans(),
                            t.poses([](unsigned) { return ""; }, 0,
                                    [](unsigned) { return std::string("1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1"); }));
       }},
      {"4 numbers per line: no rotation",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses(T::number, 0, [](unsigned i) { return T::number(i) + " 2 0.5"; }));
       }},
      {"decimal comma: write 0.25, not 0,25",
       [](const T& t) {
         return t.withPoses(t.scans(),
                            t.poses(T::number, 0, [](unsigned) { return std::string("0,25 1,5 2,5 0 0 0 1"); }));
       }},
      {"the file is UTF-16: save it as UTF-8",
       [](const T& t) { return t.withPoses(t.scans(), t.write("poses.txt", std::string("\xFF\xFE") + "0")); }},
      {"17 numbers: EuRoC?",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses(T::number, 0, [](unsigned) {
           return std::string("1 2 3 1 0 0 0 9 9 9 0.1 0.1 0.1 0.2 0.2 0.2");
         }));
       }},
      {"looks like images.txt of COLMAP",
       [](const T& t) {
         return t.withPoses(
             t.scans(), t.poses(T::number, 0, [](unsigned i) { return "1 0 0 0 4 5 6 1 " + T::number(i) + ".png"; }));
       }},
      {"the 3 x 3 part is a reflection",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses([](unsigned) { return ""; }, 0,
                                               [](unsigned) { return std::string("1 0 0 4 0 -1 0 5 0 0 1 6"); }));
       }},
      {"all 6 scans have the same pose", [](const T& t) { return t.build(t.scans([](unsigned) { return Pose(); })); }},
      {"scans have no pose of their own (the identity)",
       [](const T& t) {
         return t.build(t.scans([](unsigned i) { return i < 3 ? Pose() : T::poseOf(i); }), {"--no-pose-check"});
       }},
      {"because they were written with too few digits",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses(T::number, 0, [](unsigned i) {
           return "45512" + T::number(i) + " 5.40457e+06 310 0 0 0 1";
         }));
       }},
      {"VIEWPOINT: the positions are rounded to steps of 10 m",
       [](const T& t) {
         fs::create_directories(t.own("scans"));
         for (unsigned i = 0; i < 2; ++i)
           t.write(
               "scans/" + T::number(i) + ".pcd",
               "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 45512" +
                   T::number(i) + " 5.40457e+06 310 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 " + T::number(i) + "\n");
         return t.build(t.own("scans"));
       }},
      {"Poses must be in metres",
       [](const T& t) {
         Pose far;
         far.translation = {3e8, 0, 0};
         return t.build(t.cloud("far.pcd", T::seen(0), far));
       }},
      {"is given more than once", [](const T& t) { return t.build(t.scans(), {t.own("scans/3.pcd")}); }},
      {"are used as those of the sensor",
       [](const T& t) {
         t.write("calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\n");
         return t.withPoses(t.scans(), t.poses([](unsigned) { return ""; }, 0, T::kitti));
       }},
      // What poses mean
      {"if the points are already in the map frame", [](const T& t) { return t.build(t.inMapFrame()); }},
      {"if the poses move points from the sensor frame into the map frame",
       [](const T& t) {
         return t.build(t.scans(), {"--frame", "map"});
       }},
      {"if the poses are inverse",
       [](const T& t) { return t.build(t.scans([](unsigned i) { return T::poseOf(i).inverse(); })); }},
      {"if the quaternions are written with w first",
       [](const T& t) {
         return t.withPoses(t.scans(), t.poses(T::number, 0, [](unsigned i) {
           const Pose p = T::poseOf(i);
           std::ostringstream line;
           line.precision(12);
           line << p.translation.transpose() << ' ' << p.rotation.w() << ' ' << p.rotation.x() << ' ' << p.rotation.y()
                << ' ' << p.rotation.z();
           return line.str();
         }));
       }},
      {"if the quaternions are written with w last",
       [](const T& t) {
         return t.build(t.scans([](unsigned i) { return poseAs(PoseConvention::WFirst, T::poseOf(i)); }));
       }},
      {"if the poses are those of a camera",
       [](const T& t) {
         return t.build(t.scans([](unsigned i) { return poseAs(PoseConvention::Optical, T::poseOf(i)); }));
       }},
      {"if the points have the axes of a camera",
       [](const T& t) {
         return t.build(t.scans([](unsigned i) { return poseAs(PoseConvention::Camera, T::poseOf(i)); }));
       }},
      {"The poses may be wrong, for example their times, units or sensor",
       [](const T& t) {
         return t.build(t.scans([](unsigned i) {
           Pose pose = T::poseOf(i);
           pose.rotation =
               Pose::Rotation(pose.rotation * Eigen::AngleAxisd(1.05, Eigen::Vector3d(0.2, 0.1, 1).normalized()));
           return pose;
         }));
       }},
      {"fit each other only without the extrinsic",
       [](const T& t) {
         return t.build(t.scans(), {"--extrinsic", "0.3 0.1 0 0 0 0.5 0.8660254"});
       }},
      // Sensors
      {"but their points show that the sensor moved",
       [](const T& t) { return Words{"clean", t.withoutPositions(), "--frame", "map", "-o", t.own("c")}; }},
      {"one cloud alone shows no motion",
       [](const T& t) {
         return Words{"clean", t.cloud("merged.pcd", T::room(0)), "-o", t.own("c")};
       }},
      {"no usable point",
       [](const T& t) {
         const std::string map = t.map();
         t.cloud("empty.pcd", {});
         return Words{"register", t.own("scans/1.pcd"), t.own("empty.pcd"), map};
       }},
      {"of the scan lies on the map, so the pose may be wrong",
       [](const T& t) {
         const std::string map = t.map();
         std::mt19937 random(5);
         std::vector<Vector<3>> fog = T::seen(2);
         fog.resize(600);
         const auto anywhere = [&](double low, double high) {
           return low + (high - low) * double(random()) / 4294967295.0;
         };
         for (int i = 0; i < 6000; ++i) fog.emplace_back(anywhere(-30, 30), anywhere(-30, 30), anywhere(-5, 20));
         return Words{"register", t.cloud("fog.pcd", fog, T::poseOf(2)), map};
       }},
      {"no part of the scan lies on the map after the search",
       [](const T& t) {
         const std::string map = t.map();
         return Words{"register", t.own("scans/1.pcd"), map, "--guess", "500", "0", "0", "0", "0", "0", "1"};
       }},
      // Points
      {"the coordinates are rounded to steps of 0.5 m",
       [](const T& t) {
         return t.build(t.cloud("utm.pcd", T::moved(T::room(0), 1, {690000, 5330000, 500})), {"--frame", "map"});
       }},
      {"Are the coordinates millimetres?",
       [](const T& t) {
         return t.build(t.cloud("mm.pcd", T::moved(T::seen(0), 1000, {0, 0, 0})), {"--resolution", "100"});
       }},
      {"because floats would round them",
       [](const T& t) {
         const auto far = [](unsigned i) {
           Pose pose = T::poseOf(i);
           pose.translation += Eigen::Vector3d(690000, 5330000, 500);
           return pose;
         };
         return Words{"clean", t.scans(far), "--merged", t.own("merged.pcd")};
       }},
      {"x y z are floats, rounded by",
       [](const T& t) {
         const std::string cloud =
             t.cloud("utm.pcd", T::moved(T::room(0), 1, {690000, 5330000, 500}), {}, PcdPrecision::Double);
         t.succeed({"pcd2map", cloud, "-o", t.own("utm.gmap"), "--budget", "1", "--frame", "map"});
         return Words{"tiles", t.own("utm.gmap"), "-o", t.own("tiles"), "--floats"};
       }},
      {"the field intensity of the scans is not in the map",
       [](const T& t) {
         return t.build(
             t.write("i.pcd",
                     "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT "
                     "1\nPOINTS 2\nDATA ascii\n1 2 3 40\n4 5 6 50\n"));
       }},
      {"only the position in VIEWPOINT is used",
       [](const T& t) {
         return t.build(
             t.write(
                 "v.pcd",
                 "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 "
                 "0 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n"),
             {"--frame", "map"});
       }},
      {"none of the 3000 points is usable",
       [](const T& t) {
         return t.build(t.cloud("a.pcd", T::seen(0)), {"--min-range", "90"});
       }},
      // Files and options
      {"but its subdirectories have some: give them",
       [](const T& t) {
         fs::create_directories(t.own("dump/000000"));
         t.cloud("dump/000000/cloud.pcd", T::seen(0));
         return t.build(t.own("dump"));
       }},
      {"holds points, not Gaussians",
       [](const T& t) {
         fs::create_directory(t.own("tiles"));
         t.cloud("tiles/0_0.pcd", T::room(0));
         t.write("tiles/pointcloud_map_metadata.yaml", "x_resolution: 20.0\ny_resolution: 20.0\n0_0.pcd: [0, 0]\n");
         return Words{"tiles", t.own("tiles"), "-o", t.own("a.gmap")};
       }},
      {"holds the Gaussians of a map, not the points of a scan",
       [](const T& t) {
         const std::string map = t.map();
         t.succeed({"export", map, t.own("map.pcd")});
         return t.build(t.own("map.pcd"));
       }},
      {"this output is a map, so its name must not end in .ply",
       [](const T& t) {
         return Words{"pcd2map", t.scans(), "-o", t.own("a.ply")};
       }},
      {"are files of a directory",
       [](const T& t) {
         return Words{"clean", t.scans(), "-o", t.own("a.pcd")};
       }},
      {"--min-range: must not be above --max-range",
       [](const T& t) {
         return t.build(t.scans(), {"--min-range", "5", "--max-range", "4"});
       }},
      {"every coordinate of the first corner must be below that of the second corner",
       [](const T& t) {
         return t.build(t.scans(), {"--crop", "1", "1", "1", "2"});
       }},
      {"do not overlap",
       [](const T& t) {
         const std::string map = t.map();
         t.succeed({"pcd2map", t.cloud("far.pcd", T::moved(T::room(0), 1, {900, 0, 0})), "-o", t.own("far.gmap"),
                    "--budget", "1"});
         return Words{"diff", map, t.own("far.gmap")};
       }},
      {"no point lies near the map",
       [](const T& t) {
         const std::string map = t.map();
         return Words{"pcd2map", t.cloud("far.pcd", T::moved(T::room(0), 1, {900, 0, 0})), "--update", map};
       }},
      {"so a scan is already in",
       [](const T& t) {
         const std::string map = t.map();
         return Words{"pcd2map", t.own("scans/2.pcd"), "--update", map};
       }},
      // Recordings
      {"choose one with --topic", [](const T& t) { return t.build(recording("two_lidars.mcap")); }},
      {"no poses: the recording has no odometry", [](const T& t) { return t.build(recording("no_poses.mcap")); }},
      {"no transform in tf has the frame", [](const T& t) { return t.build(recording("without_lidar_frame.mcap")); }},
      {"scans have no pose, first", [](const T& t) { return t.build(recording("late_tf.mcap")); }},
      {"step back by", [](const T& t) { return t.build(recording("clock_reset.mcap")); }},
      {"are from different clocks: use --log-times", [](const T& t) { return t.build(recording("boot_clock.mcap")); }},
      {"this is one file of the recording in", [](const T& t) { return t.build(recording("split/drive_1.mcap")); }},
      {"tf has no such frame",
       [](const T& t) {
         return t.build(recording("tf.mcap"), {"--fixed-frame", "world"});
       }},
      {"name a frame that all recordings have with --fixed-frame",
       [](const T& t) { return t.build(recording("tf.mcap"), {recording("laser.mcap")}); }},
  };
  return all;
}

class MistakesTableRow : public MistakesTable, public testing::WithParamInterface<std::size_t> {};

TEST_P(MistakesTableRow, SaysWhatTheTableSays) {
  const Row& row = rows()[GetParam()];
  SCOPED_TRACE(row.message);
  const Outcome outcome = runApp(row.command(*this));
  EXPECT_NE(outcome.err.find(row.message), std::string::npos) << outcome.code << ": " << outcome.out << outcome.err;
}

/// "(no index 0)" as a name: "NoIndex0".
std::string testName(const testing::TestParamInfo<std::size_t>& info) {
  std::string name;
  bool starts_word = true;
  for (const char c : std::string(rows()[info.param].message)) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter)) name += starts_word ? static_cast<char>(std::toupper(letter)) : c;
    starts_word = !std::isalnum(letter);
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(OfTheDocumentation, MistakesTableRow, testing::Range(std::size_t(0), rows().size()), testName);

TEST_F(MistakesTable, HasOneTestPerRow) {
  std::ifstream page(fs::path(GAUSSMAP_DOCS) / "scans-and-poses.md");
  std::set<std::string> documented, tested;
  bool in_table = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("| mistake |", 0) == 0) in_table = true;
    if (line.empty()) in_table = false;
    if (!in_table) continue;
    const std::size_t end = line.rfind('`'), begin = end == std::string::npos ? end : line.rfind('`', end - 1);
    if (begin != std::string::npos) documented.insert(line.substr(begin + 1, end - begin - 1));
  }
  for (const Row& row : rows()) tested.insert(row.message);
  EXPECT_EQ(documented, tested);
}

}  // namespace
}  // namespace gaussmap::test
