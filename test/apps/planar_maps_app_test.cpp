// SPDX-License-Identifier: BSD-3-Clause
// Every command that reads maps, on a planar map, through the real program.
#include <cmath>
#include <sstream>

#include "apps/planar_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/io/pcd/pcd_reader.h"

namespace gaussmap::test {
namespace {

/// Two planar maps and a 3-D map of the same scans.
class PlanarMaps : public PlanarApps {
 protected:
  static std::size_t gaussiansOf(const std::string& map, int scale) {
    return infoOf(map)["scales"][std::size_t(scale)]["gaussians"].get<std::size_t>();
  }
  static std::size_t countOf(const std::string& text, const std::string& piece) {
    std::size_t count = 0;
    for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1)) ++count;
    return count;
  }
  /// A scan of the empty room, as a PCD file whose pose is wrong by 0.2 m and 3 degrees.
  std::string misplacedScan(int i) const {
    Pose wrong = PlanarRoom::pose(i);
    wrong.translation.x() += 0.2;
    wrong.rotation = wrong.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()));
    writePcd(own("scan.pcd"), PlanarRoom::points(i, false), PcdPrecision::Double, wrong);
    return own("scan.pcd");
  }
};

TEST_F(PlanarMaps, InfoTellsExtentAndAreaInThePlane) {
  const Json info = infoOf(room());
  EXPECT_EQ(info["dimensions"], 2);
  ASSERT_EQ(info["extent"]["low"].size(), 2u);
  EXPECT_NEAR(info["extent"]["low"][0], -4.0, 0.1);
  EXPECT_NEAR(info["extent"]["high"][1], 3.0, 0.11);
  EXPECT_NEAR(info["area"].get<double>(), info["scales"][0]["cells"].get<double>() * 0.01, 1e-9);
  EXPECT_EQ(infoOf(world("space.gmap")).count("dimensions"), 0u);
  const std::string text = succeed({"info", room()});
  EXPECT_NE(text.find("planar, ratio 10"), std::string::npos) << text;
  EXPECT_NE(text.find("area of the finest cells"), std::string::npos) << text;
  EXPECT_NE(text.find("error curve of scale 1"), std::string::npos) << text;
}

TEST_F(PlanarMaps, RefineReachesEveryKindOfBudget) {
  const auto refined = [&](const std::vector<std::string>& budget) {
    succeed(joined({"refine", room(), "-o", own("fine.gmap"), "--force"}, budget));
    return infoOf(own("fine.gmap"))["scales"][1];
  };
  const Json four = refined({"--budget", "4"});
  EXPECT_EQ(four["gaussians"], 4 * four["cells"].get<int>());
  EXPECT_EQ(refined({"--max-gaussians", "1=50"})["gaussians"], 50);
  EXPECT_GE(refined({"--max-error", "0.05"})["gaussians"], refined({"--max-error", "0.2"})["gaussians"]);
  refined({"--max-bytes", "30k"});
  EXPECT_LE(std::filesystem::file_size(own("fine.gmap")), 30000u);
  EXPECT_EQ(refined({"--budget", "3", "--method", "insert"})["cells"], four["cells"]);
  succeed({"pcd2map", "--planar", "--resolution", "0.1", world("room.log"), "-o", own("built.gmap"), "--max-error",
           "0.05"});
  EXPECT_EQ(gaussiansOf(own("built.gmap"), 1), refined({"--max-error", "0.05"})["gaussians"].get<std::size_t>());
}

TEST_F(PlanarMaps, CompressAndSimplifyMakeSmallerMaps) {
  succeed({"compress", room(), "-o", own("small.gmap"), "--max-error", "0.3"});
  EXPECT_EQ(infoOf(own("small.gmap"))["compressed"], true);
  EXPECT_LT(gaussiansOf(own("small.gmap"), 0), gaussiansOf(room(), 0));
  expectDataError("already compressed", {"compress", own("small.gmap"), "-o", own("no.gmap"), "--max-error", "0.3"});
  succeed({"simplify", room(), "-o", own("simple.gmap"), "--max-gaussians", "1=40"});
  EXPECT_EQ(gaussiansOf(own("simple.gmap"), 1), 40u);
  EXPECT_EQ(infoOf(own("simple.gmap"))["dimensions"], 2);
  succeed({"simplify", room(), "-o", own("simple.gmap"), "--force", "--max-bytes", "30k"});
  EXPECT_LE(std::filesystem::file_size(own("simple.gmap")), 30000u);
}

TEST_F(PlanarMaps, CropAndMergeAreExact) {
  succeed({"crop", room(), "-o", own("left.gmap"), "--box", "-10", "-10", "0", "10"});
  succeed({"crop", room(), "-o", own("right.gmap"), "--box", "-10", "-10", "0", "10", "--outside"});
  EXPECT_LT(gaussiansOf(own("left.gmap"), 0), gaussiansOf(room(), 0));
  succeed({"merge", own("left.gmap"), own("right.gmap"), "-o", own("both.gmap"), "--exact"});
  EXPECT_TRUE(load<2>(own("both.gmap")).scale(0).moments == load<2>(room()).scale(0).moments);
  succeed({"crop", room(), "-o", own("corner.gmap"), "--polygon", "0", "0", "10", "0", "10", "10"});
  EXPECT_LT(gaussiansOf(own("corner.gmap"), 0), gaussiansOf(own("right.gmap"), 0));
  expectUsageError("--box: a planar map has no heights",
                   {"crop", room(), "-o", own("no.gmap"), "--box", "0", "0", "0", "1", "1", "1"});
}

TEST_F(PlanarMaps, TransformMovesInThePlaneOnly) {
  succeed({"transform", room(), "-o", own("moved.gmap"), "--transform",
           "10 0 0 0 0 0.7071067811865476 0.7071067811865476"});
  const Json extent = infoOf(own("moved.gmap"))["extent"];
  EXPECT_NEAR(extent["low"][0], 10.0 - 3.0, 0.2);
  EXPECT_NEAR(extent["high"][1], 4.0, 0.2);
  expectDataError("the motion of a 2-D map is not planar",
                  {"transform", room(), "-o", own("no.gmap"), "--transform", "0 0 1 0 0 0 1"});
  expectDataError("not planar", {"transform", room(), "-o", own("no.gmap"), "--transform", "0 0 0 0.7071 0 0 0.7071"});
  succeed({"merge", room(), own("moved.gmap"), "-o", own("both.gmap")});
  EXPECT_EQ(infoOf(own("both.gmap"))["scales"][0]["weight"], 2.0 * (PlanarRoom::kBeams - 1) * kScans);
}

TEST_F(PlanarMaps, DiffFindsThePostThatLeft) {
  world_->write("empty.log", PlanarRoom::log(kScans));
  succeed(planar({world("empty.log"), "-o", own("empty.gmap")}));
  const Json same = Json::parse(succeed({"diff", room(), room(), "--json"}));
  EXPECT_EQ(same["gone"], 0);
  EXPECT_EQ(same["new"], 0);
  const Json left = Json::parse(succeed({"diff", room(), own("empty.gmap"), "--json", "-o", own("changes.pcd")}));
  EXPECT_GT(left["gone"], 4);
  const PcdReader changes(own("changes.pcd"));
  EXPECT_EQ(changes.size(), left["gaussians"][1].get<std::size_t>() + left["gone"].get<std::size_t>());
  EXPECT_EQ(left["new"], 0);
}

TEST_F(PlanarMaps, HausdorffComparesWithScansAndMaps) {
  const Json scans = Json::parse(succeed({"hausdorff", room(), world("room.log"), "--json"}));
  ASSERT_EQ(scans["scales"].size(), 3u);
  EXPECT_LT(scans["scales"][0]["all"]["forward"]["q95"], 0.1);
  EXPECT_LT(scans["scales"][0]["all"]["backward"]["max"], 0.1);
  const Json pcds = Json::parse(succeed({"hausdorff", room(), world("pcd"), "--json"}));
  for (std::size_t s = 0; s < 3; ++s)  // equal but for the rounding of rotations
    EXPECT_NEAR(pcds["scales"][s]["all"]["hausdorff"], scans["scales"][s]["all"]["hausdorff"], 1e-9);
  succeed({"refine", room(), "-o", own("one.gmap"), "--budget", "1"});
  const Json self = Json::parse(succeed({"hausdorff", room(), room(), "--scale", "1", "--json"}));
  EXPECT_EQ(self["scales"][0]["all"]["hausdorff"], 0.0);
  const Json other = Json::parse(succeed({"hausdorff", own("one.gmap"), room(), "--scale", "1", "--json"}));
  EXPECT_GT(other["scales"][0]["all"]["hausdorff"], 0.05);
  const Json score = Json::parse(succeed({"hausdorff", room(), world("room.log"), "--held-out", "--json"}));
  EXPECT_GT(score["scales"][0]["mean"], score["scales"][2]["mean"]);
  succeed({"hausdorff", room(), world("room.log"), "--scale", "0", "--write-errors", own("errors.pcd")});
  EXPECT_GT(PcdReader(own("errors.pcd")).size(), 0u);
}

TEST_F(PlanarMaps, HausdorffTakesASliceOfScansInSpace) {
  succeed({"simulate", "hall", "-o", own("hall"), "--scans", "4", "--columns", "360"});
  const std::string scans = own("hall/scans"), map = own("map.gmap");
  succeed({"pcd2map", "--planar", "--slice", "1", "2", scans, "-o", map, "--resolution", "0.2"});
  const Json all = Json::parse(succeed({"hausdorff", map, scans, "--slice", "1", "2", "--scale", "0", "--json"}));
  EXPECT_LT(all["scales"][0]["all"]["backward"]["max"], 0.2);
  expectDataError("(--slice Z0 Z1)", {"hausdorff", map, scans});
  expectUsageError("a planar map cannot be compared with a mesh", {"hausdorff", map, own("hall/truth.ply")});
  expectUsageError("--slice: only for planar maps", {"hausdorff", world("space.gmap"), scans, "--slice", "1", "2"});
  expectUsageError("--slice: only for planar maps", {"hausdorff", scans, scans, "--slice", "1", "2"});
  expectUsageError("--crop: a planar map has no heights",
                   {"hausdorff", map, scans, "--slice", "1", "2", "--crop", "0", "0", "0", "1", "1", "1"});
}

TEST_F(PlanarMaps, RegisterFindsThePoseOfAPlanarScan) {
  const Json found = Json::parse(succeed({"register", misplacedScan(12), room(), "--json"})).at(0);
  const Pose truth = PlanarRoom::pose(12);
  EXPECT_NEAR(found["translation"][0], truth.translation.x(), 0.01);
  EXPECT_NEAR(found["translation"][1], truth.translation.y(), 0.01);
  EXPECT_EQ(found["translation"][2], 0.0);
  EXPECT_NEAR(found["quaternion_xyzw"][2], truth.rotation.z(), 0.005);
  EXPECT_GT(found["fitness"], 0.8);
  const std::string text = succeed({"register", world("room.log"), room(), "--tum", own("poses.tum")});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), kScans);
  EXPECT_NE(contentsOf(own("poses.tum")).find("101.5"), std::string::npos);  // the times of the log
}

TEST_F(PlanarMaps, RegisterTakesASliceOfScansInSpace) {
  succeed({"simulate", "hall", "-o", own("hall"), "--scans", "8", "--columns", "720"});
  const std::string map = own("map.gmap"), scan = own("hall/scans/scan04.pcd");
  succeed({"pcd2map", "--planar", "--slice", "1", "2", own("hall/scans"), "-o", map, "--resolution", "0.2", "--ratio",
           "3", "--scales", "4"});
  const Json found = Json::parse(succeed({"register", scan, map, "--slice", "1", "2", "--json"})).at(0);
  const Pose pose = PcdReader(scan).header().viewpoint;
  EXPECT_NEAR(found["translation"][0], pose.translation.x(), 0.03);
  EXPECT_NEAR(found["translation"][1], pose.translation.y(), 0.03);
  expectDataError("(--slice Z0 Z1)", {"register", scan, map});
  expectDataError("no usable point between the heights of --slice", {"register", scan, map, "--slice", "50", "60"});
  expectUsageError("--slice: only for planar maps", {"register", scan, world("space.gmap"), "--slice", "1", "2"});
  expectDataError("cannot be combined with a planar map", {"register", world("space.gmap"), map});
}

TEST_F(PlanarMaps, CleanRemovesThePostFromPlanarScans) {
  const std::string said = succeed({"clean", world("pcd"), "-o", own("clean"), "--removed", own("removed.pcd")});
  EXPECT_NE(said.find("24 scans"), std::string::npos) << said;
  const std::vector<double> x = PcdReader(own("removed.pcd")).column("x");
  ASSERT_GT(x.size(), 30u);
  for (const double one : x) EXPECT_NEAR(one, 2.0, 0.4);
  succeed({"clean", world("room.log"), "--merged", own("static.pcd")});
  EXPECT_EQ(PcdReader(own("static.pcd")).size() + x.size(), std::size_t{PlanarRoom::kBeams * kScans});
}

TEST_F(PlanarMaps, ExportWritesFlatGaussians) {
  std::size_t all = 0;
  for (int s = 0; s < 3; ++s) all += gaussiansOf(room(), s);
  for (const char* const name : {"map.pcd", "map.ply", "map.vtp", "map.csv"}) {
    const std::string said = succeed({"export", room(), own(name), "--scale", "0"});
    EXPECT_NE(said.find(std::to_string(gaussiansOf(room(), 0)) + " Gaussians"), std::string::npos) << said;
  }
  succeed({"export", room(), own("all.pcd")});
  EXPECT_EQ(PcdReader(own("all.pcd")).size(), all);
  const GaussianMapOctree flat = loadPcd(own("map.pcd"));
  ASSERT_EQ(flat.gaussianCount(0), gaussiansOf(room(), 0));
  for (std::size_t i = 0; i < flat.gaussianCount(0); ++i) EXPECT_NEAR(flat.gaussian(i, 0).mean.z(), 0.0, 1e-6);
}

TEST_F(PlanarMaps, DrawOneScaleOrTheCoarsestOverTheFinest) {
  succeed({"draw", room(), "-o", own("plain.svg"), "--scale", "1"});
  const std::string plain = contentsOf(own("plain.svg"));
  EXPECT_EQ(countOf(plain, "<ellipse"), gaussiansOf(room(), 1));
  EXPECT_EQ(plain.find("top of the ellipsoid"), std::string::npos);  // there are no heights
  const std::string said = succeed({"draw", room(), "-o", own("both.svg"), "--overlay", "--scale", "1"});
  const std::string both = contentsOf(own("both.svg"));
  EXPECT_EQ(countOf(both, "<ellipse"), gaussiansOf(room(), 1) + gaussiansOf(room(), 0)) << said;
  EXPECT_EQ(countOf(both, "color='#d61f1f'"), gaussiansOf(room(), 0));
  const std::size_t squares = both.find("stroke='black' stroke-width='.9' d='");
  ASSERT_NE(squares, std::string::npos);
  EXPECT_EQ(countOf(both.substr(squares, both.find("'/>", squares) - squares), "M"),
            infoOf(room())["scales"][1]["cells"].get<std::size_t>());
  succeed({"draw", room(), world("space.gmap"), "-o", own("two.svg")});
  EXPECT_NE(contentsOf(own("two.svg")).find("top of the ellipsoid"), std::string::npos);
  expectUsageError("--overlay draws a coarse scale",
                   {"draw", room(), "-o", own("no.svg"), "--overlay", "--scale", "0"});
}

TEST_F(PlanarMaps, ViewSavesAPicture) {
  if (GAUSSMAP_HAS_VIEWER == 0) GTEST_SKIP() << "built without the viewer";
  succeed({"view", room(), "--png", own("top.png"), "--size", "320x200"});
  succeed({"view", room(), "--png", own("also_top.png"), "--size", "320x200", "--view", "top"});
  succeed({"view", room(), "--png", own("iso.png"), "--size", "320x200", "--view", "iso"});
  EXPECT_TRUE(contentsOf(own("top.png")) == contentsOf(own("also_top.png")));
  EXPECT_FALSE(contentsOf(own("top.png")) == contentsOf(own("iso.png")));
  // From above, the scales of a hierarchy would hide each other, and all heights are equal.
  succeed({"view", room(), "--png", own("lifted.png"), "--size", "320x200", "--hierarchy"});
  succeed({"view", room(), "--png", own("also.png"), "--size", "320x200", "--hierarchy", "--view", "iso", "--color",
           "scale"});
  EXPECT_TRUE(contentsOf(own("lifted.png")) == contentsOf(own("also.png")));
}

TEST_F(PlanarMaps, FinishMakesAFinalMap) {
  succeed({"finish", room(), "-o", own("final.gmap")});
  const Json info = infoOf(own("final.gmap"));
  EXPECT_EQ(info["final"], true);
  EXPECT_EQ(info["dimensions"], 2);
  EXPECT_LT(info["bytes"], infoOf(room())["bytes"]);
  expectDataError("accepts no more scans", {"pcd2map", "--update", own("final.gmap"), world("room.log")});
}

TEST_F(PlanarMaps, AreNotCombinedWithMapsInSpace) {
  const std::string space = world("space.gmap");
  expectDataError("is a 3-D map, which cannot be combined with a planar map",
                  {"merge", room(), space, "-o", own("no.gmap")});
  expectDataError("is a planar map, which cannot be combined with a 3-D map",
                  {"merge", space, room(), "-o", own("no.gmap")});
  expectDataError("cannot be combined", {"diff", room(), space});
  expectDataError("cannot be combined", {"hausdorff", space, room()});
  expectDataError("is a planar map, but tiles are for localisation", {"tiles", room(), "-o", own("tiles")});
}

}  // namespace
}  // namespace gaussmap::test
