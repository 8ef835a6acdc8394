// SPDX-License-Identifier: BSD-3-Clause
// gaussmap export: one file of every kind, and the combinations that make no sense.
#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/mesh/ply.h"
#include "io/mesh/ply_vertices.h"

namespace gaussmap::test {
namespace {

class ExportApp : public Apps {
 protected:
  static std::string map() { return scene("map.gmap").string(); }
  static std::size_t gaussians(int scale) {
    return infoOf(map())["scales"][static_cast<std::size_t>(scale)]["gaussians"].get<std::size_t>();
  }
};

TEST_F(ExportApp, WritesEveryKindOfFileAndSaysHowManyGaussiansAreInIt) {
  const std::string all = std::to_string(gaussians(0) + gaussians(1) + gaussians(2)) + " Gaussians",
                    finest = std::to_string(gaussians(0)) + " Gaussians";
  EXPECT_NE(succeed({"export", map(), own("a.pcd")}).find(all), std::string::npos);
  EXPECT_NE(succeed({"export", map(), own("a.csv")}).find(all), std::string::npos);
  EXPECT_NE(succeed({"export", map(), own("a.vtp")}).find(all), std::string::npos);
  EXPECT_NE(succeed({"export", map(), own("a.ply")}).find(finest), std::string::npos);
  EXPECT_EQ(contentsOf(own("a.vtp")).substr(0, 21), "<?xml version=\"1.0\"?>");
  EXPECT_EQ(contentsOf(own("a.csv")).substr(0, 16), "scale,cell_side,");
  EXPECT_EQ(ownFiles(), (std::vector<std::string>{"a.csv", "a.pcd", "a.ply", "a.vtp"}));
}

TEST_F(ExportApp, OptionsChooseWhatAPlyHolds) {
  succeed({"export", map(), own("s.ply"), "--as", "splats", "--scale", "1", "--color", "normal"});
  const PlyVertices splats = plyVertices(contentsOf(own("s.ply")));
  EXPECT_EQ(splats.count, gaussians(1));
  EXPECT_EQ(splats.names.size(), 62u);
  succeed({"export", map(), own("p.ply"), "--as", "points", "--scale", "2"});
  EXPECT_EQ(plyVertices(contentsOf(own("p.ply"))).count, gaussians(2));
  succeed({"export", map(), own("e.ply"), "--as", "ellipsoids", "--scale", "2", "--sigma", "1"});
  EXPECT_EQ(readPly(own("e.ply")).triangles.size(), 48 * gaussians(2));
}

TEST_F(ExportApp, RefusesWhatMakesNoSense) {
  for (const std::string ending : {".pcd", ".vtp", ".csv"}) {
    expectUsageError("--as", {"export", map(), own("a" + ending), "--as", "splats"});
    expectUsageError("--color", {"export", map(), own("a" + ending), "--color", "height"});
    expectUsageError("--sigma", {"export", map(), own("a" + ending), "--sigma", "2"});
  }
  expectUsageError("--sigma", {"export", map(), own("a.ply"), "--as", "splats", "--sigma", "2"});
  expectUsageError("--sigma", {"export", map(), own("a.ply"), "--sigma", "0"});
  expectUsageError("--as", {"export", map(), own("a.ply"), "--as", "cubes"});
  expectUsageError(".vtp", {"export", map(), own("a.obj")});
  for (const std::string ending : {".pcd", ".ply", ".vtp", ".csv"}) {
    expectUsageError("--scale", {"export", map(), own("a" + ending), "--scale", "3"});
    expectDataError("no.gmap", {"export", own("no.gmap"), own("a" + ending)});
  }
  directory_.write("mine.ply", "mine");
  expectUsageError("--force", {"export", map(), own("mine.ply")});
  EXPECT_EQ(contentsOf(own("mine.ply")), "mine");
  succeed({"export", map(), own("mine.ply"), "--force", "--as", "points"});
}

}  // namespace
}  // namespace gaussmap::test
