// SPDX-License-Identifier: BSD-3-Clause
// gaussmap compress through the real program.
#include <memory>

#include "apps/app_fixture.h"

namespace gaussmap::test {
namespace {

const char* const kError = "0.1";  // [m]: about half of the cells of 1 m are good enough then

class CompressApp : public AppTest {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(runApp({"simulate", "-o", scene(""), "--columns", "200"}).code, 0);
    ASSERT_EQ(runApp({"pcd2map", scene("scans"), "-o", scene("map.gmap")}).code, 0);
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static std::string scene(const std::string& name) { return (scene_->path() / name).string(); }
  static std::string map() { return scene("map.gmap"); }

  /// Compresses the map of the scene; the path of the result.
  std::string compressed(const std::string& max_error, const std::string& name = "small.gmap") const {
    succeed({"compress", map(), "-o", own(name), "--max-error", max_error});
    return own(name);
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> scene_;
};

TEST_F(CompressApp, MakesASmallerMapAndSaysWhatIsLeft) {
  const Json said = Json::parse(succeed({"compress", map(), "-o", own("small.gmap"), "--max-error", kError, "--json"}));
  const Json before = infoOf(map()), after = infoOf(own("small.gmap"));
  EXPECT_EQ(said["map"], own("small.gmap"));
  EXPECT_EQ(said["max_error"], 0.1);
  EXPECT_EQ(said["bytes"], std::filesystem::file_size(own("small.gmap")));
  EXPECT_EQ(said["bytes_before"], std::filesystem::file_size(map()));
  EXPECT_LT(said["bytes"], said["bytes_before"]);
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(said["scales"][s]["cells"], after["scales"][s]["cells"]);
    EXPECT_EQ(said["scales"][s]["gaussians"], after["scales"][s]["gaussians"]);
    EXPECT_EQ(said["scales"][s]["cells_before"], before["scales"][s]["cells"]);
    EXPECT_EQ(said["scales"][s]["gaussians_before"], before["scales"][s]["gaussians"]);
  }
  EXPECT_LT(after["scales"][0]["cells"], before["scales"][0]["cells"]);
  EXPECT_EQ(after["scales"][2]["gaussians"], before["scales"][2]["gaussians"]);
  const std::string text = succeed({"compress", map(), "-o", own("again.gmap"), "--max-error", kError});
  EXPECT_NE(text.find("again.gmap: max error 0.1 m"), std::string::npos) << text;
}

TEST_F(CompressApp, MakesAMapThatInfoCallsCompressed) {
  const Json before = infoOf(map()), after = infoOf(compressed(kError));
  EXPECT_EQ(before["compressed"], false);
  EXPECT_EQ(before["takes_scans"], true);
  EXPECT_EQ(after["compressed"], true);
  EXPECT_EQ(after["takes_scans"], false);
  EXPECT_EQ(before["scales"][0]["leaf_share"], 1.0);
  double share = 0.0;
  for (const Json& scale : after["scales"]) share += scale["leaf_share"].get<double>();
  EXPECT_NEAR(share, 1.0, 1e-9);
  EXPECT_GT(after["scales"][1]["leaf_cells"], 0);
  EXPECT_LT(after["scales"][1]["leaf_cells"], after["scales"][1]["cells"]);
  EXPECT_EQ(after["metadata"]["history"].back()["command"], "compress");
  EXPECT_EQ(after["metadata"]["history"].back()["max_error"], 0.1);
  EXPECT_FALSE(after["metadata"].contains("error_curves"));  // they tell of whole scales
  const std::string text = succeed({"info", own("small.gmap")});
  EXPECT_NE(text.find("accepts no more scans"), std::string::npos) << text;
  EXPECT_NE(text.find("leaves of scale 1: "), std::string::npos) << text;
}

TEST_F(CompressApp, DeletesMoreTheLargerTheError) {
  std::uintmax_t bytes = std::filesystem::file_size(map());
  for (const std::string max_error : {"0.08", "0.1", "2"}) {
    const std::uintmax_t now = std::filesystem::file_size(compressed(max_error, max_error + ".gmap"));
    EXPECT_LT(now, bytes);
    bytes = now;
  }
  const Json same = infoOf(compressed("1e-6", "same.gmap"));
  EXPECT_EQ(same["compressed"], false);
  EXPECT_EQ(same["takes_scans"], true);
  EXPECT_EQ(same["scales"][0]["cells"], infoOf(map())["scales"][0]["cells"]);
}

TEST_F(CompressApp, WritesTheSameBytesOnAnyNumberOfThreads) {
  const std::string all = contentsOf(compressed(kError));
  for (const std::string threads : {"1", "2"}) {
    const std::string name = own(threads + ".gmap");
    succeed({"compress", map(), "-o", name, "--max-error", kError, "--threads", threads});
    EXPECT_EQ(contentsOf(name), all);
  }
}

TEST_F(CompressApp, TakesAndGivesPcd) {
  succeed({"export", map(), own("map.pcd")});
  succeed({"compress", own("map.pcd"), "-o", own("of_pcd.gmap"), "--max-error", kError});
  EXPECT_EQ(infoOf(own("of_pcd.gmap"))["compressed"], true);
  succeed({"export", compressed(kError), own("small.pcd")});
  const Json of_pcd = infoOf(own("small.pcd")), of_map = infoOf(own("small.gmap"));
  EXPECT_EQ(of_pcd["compressed"], true);
  for (std::size_t s = 0; s < 3; ++s)
    EXPECT_EQ(of_pcd["scales"][s]["leaf_gaussians"], of_map["scales"][s]["leaf_gaussians"]);
}

TEST_F(CompressApp, IsMeasuredAsAWhole) {
  const std::string small = compressed(kError);
  const auto levels = [&](std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    return Json::parse(succeed(arguments))["scales"];
  };
  const Json all = levels({"hausdorff", small, scene("scans")});
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0]["scale"], "leaves");
  EXPECT_EQ(all[1]["scale"], 0);
  EXPECT_LT(all[0]["all"]["forward"]["q95"], 0.1);
  EXPECT_LT(all[0]["all"]["backward"]["q95"], 0.1);
  EXPECT_GT(all[1]["all"]["backward"]["q95"], 0.1);  // the finest scale alone lacks what was deleted
  const Json leaves = levels({"hausdorff", small, scene("scans"), "--leaves"});
  ASSERT_EQ(leaves.size(), 1u);
  EXPECT_EQ(leaves[0], all[0]);
  const Json of_maps = levels({"hausdorff", small, map(), "--leaves"});
  EXPECT_LT(of_maps[0]["all"]["forward"]["q95"], 0.1);
  EXPECT_EQ(levels({"hausdorff", map(), scene("scans")}).size(), 3u);  // not compressed: its scales
  const Json scores = levels({"hausdorff", small, scene("scans"), "--held-out"});
  EXPECT_EQ(scores[0]["scale"], "leaves");
  EXPECT_EQ(scores[0]["in_no_cell"], 0.0);
  EXPECT_GT(scores[0]["mean"], scores[1]["mean"]);
  expectUsageError("--leaves", {"hausdorff", small, scene("scans"), "--leaves", "--scale", "1"});
}

TEST_F(CompressApp, SkipsScalesThatAreGone) {
  const std::string bare = compressed("100");
  ASSERT_EQ(infoOf(bare)["scales"][0]["cells"], 0);
  const Json said = Json::parse(succeed({"hausdorff", bare, scene("scans"), "--json"}))["scales"];
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[0]["scale"], "leaves");
  EXPECT_EQ(said[1]["scale"], 2);
  expectDataError("no samples", {"hausdorff", bare, scene("scans"), "--scale", "0", "--json"});
  succeed({"export", bare, own("bare.pcd")});
  EXPECT_EQ(infoOf(own("bare.pcd"))["scales"].size(), 1u);
}

TEST_F(CompressApp, IsTheLastStep) {
  const std::string small = compressed(kError);
  expectDataError("compressed", {"refine", small, "-o", own("x.gmap"), "--budget", "2"});
  expectDataError("compressed", {"refine", small, "-o", own("x.gmap"), "--budget", "1"});
  expectDataError("compressed", {"refine", small, "-o", own("x.gmap"), "--max-gaussians", "99999"});
  expectDataError("compressed", {"compress", small, "-o", own("x.gmap"), "--max-error", "0.5"});
}

TEST_F(CompressApp, SaysWhatIsWrongWithItsOptions) {
  const std::string out = own("x.gmap");
  expectUsageError("--max-error", {"compress", map(), "-o", out});
  for (const std::string bad : {"0", "-1", "nan", "inf", "wide", ""})
    expectUsageError("max-error", {"compress", map(), "-o", out, "--max-error", bad});
  expectUsageError("--output", {"compress", map(), "--max-error", "0.1"});
  expectUsageError("map", {"compress", "-o", out, "--max-error", "0.1"});
  expectUsageError("destroy the input", {"compress", map(), "-o", map(), "--max-error", "0.1", "--force"});
  expectUsageError("PCD", {"compress", map(), "-o", own("x.pcd"), "--max-error", "0.1"});
  expectUsageError("--threads", {"compress", map(), "-o", out, "--max-error", "0.1", "--threads", "-2"});
  const std::string small = compressed(kError);
  const std::string kept = contentsOf(small);
  expectUsageError("exists already", {"compress", map(), "-o", small, "--max-error", "0.3"});
  EXPECT_EQ(contentsOf(small), kept);
  succeed({"compress", map(), "-o", small, "--max-error", "0.3", "--force"});
  EXPECT_NE(contentsOf(small), kept);
}

TEST_F(CompressApp, SaysWhatIsWrongWithItsInput) {
  expectDataError("does not exist", {"compress", own("none.gmap"), "-o", own("x.gmap"), "--max-error", "0.1"});
  expectDataError("scan", {"compress", scene("scans") + "/scan_000.pcd", "-o", own("x.gmap"), "--max-error", "0.1"});
}

}  // namespace
}  // namespace gaussmap::test
