// SPDX-License-Identifier: BSD-3-Clause
// Scans of all kinds through the real program: how a kind is recognised, what is refused, and what becomes of poses,
// values and coordinate reference systems.
#include <fstream>
#include <map>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "io/files/file_contents.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

std::string formatsFile(const std::string& name) {
  return GAUSSMAP_TEST_DATA "/formats/" + name;
}

class FormatsApp : public AppTest {
 protected:
  std::string copy(const std::string& file, const std::string& name) const {
    fs::create_directories(fs::path(own(name)).parent_path());
    fs::copy_file(formatsFile(file), own(name));
    return own(name);
  }
  std::string write(const std::string& name, const std::string& bytes) const { return directory_.write(name, bytes); }

  std::string kindOf(const std::string& path) const {
    const Json json = Json::parse(succeed({"scans", path, "--json"}));
    return json["scans"].at(0)["kind"].get<std::string>();
  }
};

TEST_F(FormatsApp, RecogniseAKindByItsContentNotByItsName) {
  const std::map<std::string, std::string> kinds = {
      {"same_scans/pcd/000000.pcd", "PCD binary"},
      {"same_scans/ply/000000.ply", "PLY binary_little_endian"},
      {"same_scans/las/000000.las", "LAS 1.2, point format 0"},
      {"same_scans/laz/000000.laz", "LAZ 1.2, point format 0"},
      {"same_scans/scans.e57", "E57 1.0"},
      {"same_scans/zstd.mcap", "MCAP (zstd), sensor_msgs/PointCloud2"},
      {"same_scans/rosbag2/rosbag2_0.db3", "rosbag2 sqlite3, sensor_msgs/PointCloud2"},
      {"same_scans/scans.bag", "ROS 1 bag, sensor_msgs/PointCloud2"},
      {"text/plain.xyz", "text, 4 columns separated by blanks"},
      {"text/two.pts", "PTS text, 7 columns separated by blanks"}};
  for (const auto& [file, kind] : kinds) {
    SCOPED_TRACE(file);
    const std::string name = std::to_string(directory_.path().string().size()) + fs::path(file).filename().string();
    EXPECT_EQ(kindOf(copy(file, name + "_renamed")), kind);
    EXPECT_EQ(kindOf(copy(file, name + ".las")), kind);
  }
  // Raw records have no signature, so their name counts.
  EXPECT_EQ(kindOf(formatsFile("same_scans/bin/000000.bin")), "raw records of KITTI, x:f32 y:f32 z:f32 intensity:f32");
  expectDataError("is not a kind of file that gaussmap reads", {"scans", copy("same_scans/bin/000000.bin", "raw")});
}

TEST_F(FormatsApp, SayWhatAFileIsThatHoldsNoScans) {
  expectDataError("is a PNG picture", {"scans", write("a.dat", "\x89PNG\r\n\x1a\n" + std::string(100, 'x'))});
  expectDataError("pcap", {"scans", write("b.pcap", "\xD4\xC3\xB2\xA1" + std::string(100, '\1'))});
  expectDataError("is compressed with gzip; expand it with gunzip",
                  {"scans", write("c.ply.gz", "\x1F\x8B\x08" + std::string(100, '\1'))});
  expectDataError("the file is empty", {"scans", write("d.las", "")});
  expectDataError("describes a recording", {"scans", write("metadata.yaml", "rosbag2_bagfile_information:\n  x: 1\n")});
  expectDataError("is a map, not a file of scans", {"scans", GAUSSMAP_TEST_DATA "/map_of_the_first_program.gmap"});
}

TEST_F(FormatsApp, TakeTheFilesOfOneKindOfADirectory) {
  fs::create_directory(own("mixed"));
  copy("same_scans/ply/000000.ply", "mixed/a.ply");
  copy("same_scans/las/000000.las", "mixed/b.las");
  expectDataError("holds files of several kinds: .las (1 file), .ply (1 file); give the files to read",
                  {"scans", own("mixed")});
  copy("same_scans/pcd/000000.pcd", "mixed/c.pcd");
  EXPECT_EQ(kindOf(own("mixed")), "PCD binary");
  fs::create_directory(own("texts"));
  copy("text/plain.xyz", "texts/a.txt");
  expectDataError("if the .txt files are scans, give them: ", {"scans", own("texts")});
}

TEST_F(FormatsApp, UseTheFieldsThatAreGiven) {
  // Records of x y z and a byte that is skipped.
  std::string records;
  for (int i = 0; i < 4; ++i) {
    const float point[3] = {static_cast<float>(1000 * i), 500.0f, 0.0f};
    records.append(reinterpret_cast<const char*>(point), sizeof(point));
    records.push_back('\7');
  }
  const std::string file = write("records.bin", records);
  expectDataError("--fields", {"scans", file});
  const Json json = Json::parse(succeed({"scans", file, "--fields", "x:mm y:mm z:mm -:u8", "--json"}));
  EXPECT_EQ(json["points"]["accepted"], 4);
  EXPECT_EQ(json["box"]["high"], Json({3.0, 0.5, 0.0}));
  expectUsageError("--fields: ", {"scans", file, "--fields", "x y"});
  expectDataError("only text files and raw records (.bin) have fields to name",
                  {"scans", formatsFile("same_scans/las/000000.las"), "--fields", "x y z"});
}

TEST_F(FormatsApp, RefuseOptionsOfRecordingsForOtherFiles) {
  const std::string file = formatsFile("same_scans/las/000000.las");
  expectUsageError("--topic: needs a recording", {"scans", file, "--topic", "/points"});
  expectUsageError("--fixed-frame: needs poses of a recording", {"scans", file, "--fixed-frame", "map"});
  expectUsageError("--log-times: needs a recording", {"scans", file, "--log-times"});
  expectUsageError("--max-time-gap: needs --poses", {"scans", file, "--max-time-gap", "1"});
  expectDataError("/odom", {"scans", file, "--poses", "/odom"});  // a file that does not exist
}

TEST_F(FormatsApp, KeepTheCoordinateReferenceSystemOfTheFiles) {
  const std::string utm = formatsFile("las/format0_1.0.las"), wkt = formatsFile("las/format6_1.4.las"),
                    map = own("a.gmap");
  succeed({"pcd2map", utm, "-o", map, "--no-curves"});
  const auto systemOf = [](const std::string& path) {
    const MapMetadata metadata = loadMetadata(path);
    const auto entry = metadata.find(kCoordinateSystemEntry);
    return entry == metadata.end() ? std::string() : entry->second;
  };
  EXPECT_EQ(systemOf(map), "EPSG:32632 (WGS 84 / UTM zone 32N)");
  EXPECT_NE(succeed({"info", map}).find("coordinate reference system: EPSG:32632"), std::string::npos);
  succeed({"refine", map, "-o", own("refined.gmap"), "--budget", "2"});
  EXPECT_EQ(systemOf(own("refined.gmap")), systemOf(map));

  const Outcome both = runApp({"pcd2map", utm, wkt, "-o", own("both.gmap"), "--no-curves"});
  EXPECT_NE(both.err.find("the coordinate reference system differs"), std::string::npos) << both.err;
  EXPECT_EQ(systemOf(own("both.gmap")), systemOf(map));
  EXPECT_NE(runApp({"pcd2map", wkt, "--update", map}).err.find("reference system differs"), std::string::npos);

  succeed({"pcd2map", wkt, "-o", own("wkt.gmap"), "--no-curves"});
  EXPECT_NE(succeed({"info", own("wkt.gmap")}).find("coordinate reference system: PROJCS \""), std::string::npos);
  const Outcome merged = runApp({"merge", own("refined.gmap"), own("wkt.gmap"), "-o", own("merged.gmap")});
  EXPECT_NE(merged.err.find("reference system differs"), std::string::npos) << merged.err;
  succeed({"transform", own("refined.gmap"), "-o", own("moved.gmap"), "--transform", "-400000 0 0 0 0 0 1"});
  EXPECT_EQ(systemOf(own("moved.gmap")), "");
}

TEST_F(FormatsApp, RefuseToChangePosesThatTheyDoNotHave) {
  const std::string ply = formatsFile("same_scans/ply/000000.ply"), las = formatsFile("same_scans/las/000000.las");
  for (const char* const convention : {"inverse", "w-last", "camera"})
    expectDataError("has no pose, so --pose-convention has nothing to convert",
                    {"scans", ply, "--pose-convention", convention});
  expectDataError("the order of its quaternions is known",
                  {"scans", formatsFile("same_scans/scans.e57"), "--pose-convention", "w-last"});
  expectDataError("so --extrinsic has nothing to move", {"scans", las, "--extrinsic", "0 0 1 0 0 0 1"});
  expectDataError("use --crop", {"pcd2map", las, "-o", own("a.gmap"), "--max-range", "5"});
}

TEST_F(FormatsApp, SayWhatTheyDoNotRead) {
  const auto warningsOf = [](const Words& words) { return runApp(words).out; };
  fs::create_directory(own("mixed"));
  copy("same_scans/pcd/000000.pcd", "mixed/a.pcd");
  copy("same_scans/las/000000.las", "mixed/b.las");
  EXPECT_NE(warningsOf({"scans", own("mixed")}).find("only the .pcd files are read"), std::string::npos);
  EXPECT_NE(warningsOf({"scans", formatsFile("ply/pcl_binary.ply")}).find("the pose in the element camera"),
            std::string::npos);
  expectDataError("the rows are the Gaussians of a map",
                  {"scans", write("map.csv", "scale,cell_side,x,y,z,cov_xx\n0,0.1,1,2,3,1\n")});
  expectDataError("if the rows are poses, give the file with --poses", {"scans", write("p.txt", "1 2 3 0 0 0 1 9\n")});
  expectDataError("is an archive (tar, gzip); expand it with tar xzf",
                  {"scans", write("a.tar.gz", "\x1F\x8B\x08" + std::string(100, '\1'))});
  expectDataError("UTF-16: save it as UTF-8", {"scans", write("u.csv", "\xFF\xFEx")});
}

TEST_F(FormatsApp, NeedSensorPositionsToFollowRays) {
  const std::string las = formatsFile("same_scans/las");
  expectDataError("does not say where the sensor was", {"pcd2map", las, "-o", own("a.gmap"), "--online"});
  expectDataError("give the positions of the sensor with --poses FILE", {"clean", las, "-o", own("clean")});
}

TEST_F(FormatsApp, CleanScansOfARecordingAsPcdFiles) {
  succeed({"clean", formatsFile("same_scans/zstd.mcap"), "-o", own("clean")});
  for (int i = 0; i < 6; ++i) {
    SCOPED_TRACE(i);
    const PcdReader cleaned(own("clean/zstd_00000" + std::to_string(i) + ".pcd"));
    const PcdReader original(formatsFile("same_scans/pcd/00000" + std::to_string(i) + ".pcd"));
    EXPECT_TRUE(cleaned.header().viewpoint.translation == original.header().viewpoint.translation);
    EXPECT_TRUE(cleaned.header().viewpoint.rotation.coeffs() == original.header().viewpoint.rotation.coeffs());
    EXPECT_EQ(cleaned.size(), original.size());
    for (const char* const field : {"x", "y", "z", "intensity"})
      EXPECT_EQ(cleaned.column(field), original.column(field)) << field;
  }
}

TEST_F(FormatsApp, CleanTextsAsPcdFiles) {
  std::string text = "x y z\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(5 + i % 10) + " " + std::to_string(i / 10) + " 1\n";
  succeed({"clean", write("a.csv", text), write("b.csv", text + "5 5 2\n"), "-o", own("clean"), "--poses",
           write("poses.txt", "a 0 0 0 0 0 0 1\nb 0.1 0 0 0 0 0 1\n"), "--no-pose-check"});
  EXPECT_EQ(PcdReader(own("clean/a.pcd")).size(), 100u);
  EXPECT_EQ(PcdReader(own("clean/b.pcd")).size(), 101u);
}

TEST_F(FormatsApp, RegisterEachScanOfARecording) {
  const std::string bag = formatsFile("same_scans/scans.bag");
  succeed({"pcd2map", bag, "-o", own("map.gmap"), "--no-curves"});
  const Json found = Json::parse(succeed({"register", bag, own("map.gmap"), "--tum", own("found.tum"), "--json"}));
  ASSERT_EQ(found.size(), 6u);
  EXPECT_EQ(found[2]["scan"], bag + ": /points 1700000000.200000000");
  std::ifstream poses(formatsFile("same_scans/poses.tum")), tum(own("found.tum"));
  std::string line, expected;
  for (int i = 0; i < 6; ++i) {
    while (std::getline(poses, expected) && expected[0] == '#') {
    }
    while (std::getline(tum, line) && line[0] == '#') {
    }
    double time = 0.0, x = 0.0, time0 = 0.0, x0 = 0.0;
    std::istringstream(line) >> time >> x;
    std::istringstream(expected) >> time0 >> x0;
    EXPECT_NEAR(time, time0, 1e-6);
    EXPECT_NEAR(x, x0, 0.05);
  }
}

TEST_F(FormatsApp, CompareWithCloudsAndMeshesInPly) {
  const std::string ply = formatsFile("same_scans/ply/000000.ply"), pcd = formatsFile("same_scans/pcd/000000.pcd");
  const Json same = Json::parse(succeed({"hausdorff", ply, pcd, "--frame", "map", "--json"}));
  EXPECT_EQ(same["all"]["hausdorff"], 0.0) << same;
  const std::string mesh = write("mesh.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                 "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  expectUsageError("a mesh can only be the reference", {"hausdorff", mesh, ply});
  EXPECT_EQ(runApp({"hausdorff", ply, mesh}).code, 0);
}

}  // namespace
}  // namespace gaussmap::test
