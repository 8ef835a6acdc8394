// SPDX-License-Identifier: BSD-3-Clause
// gaussmap merge, transform, crop and simplify through the real program.
#include <algorithm>
#include <fstream>
#include <memory>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

const char* const kPose = "3 -2 0.5 0 0 0.6 0.8";

class MergeApp : public AppTest {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(runApp({"simulate", "-o", scene(""), "--rings", "8", "--columns", "90"}).code, 0);
    std::vector<std::string> scans;
    for (const auto& entry : std::filesystem::directory_iterator(scene("scans")))
      scans.push_back(entry.path().string());
    std::sort(scans.begin(), scans.end());
    const std::size_t half = scans.size() / 2;
    build({scans.begin(), scans.begin() + std::ptrdiff_t(half)}, "a.gmap");
    build({scans.begin() + std::ptrdiff_t(half), scans.end()}, "b.gmap");
    build(scans, "all.gmap");
    build(scans, "plain.gmap", {"--budget", "1"});
    build(scans, "coarse.gmap", {"--resolution", "0.2"});
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static std::string scene(const std::string& name) { return (scene_->path() / name).string(); }
  static GaussianMap<3> load(const std::string& path) { return gaussmap::load(path); }

 private:
  static void build(std::vector<std::string> scans, const std::string& name,
                    const std::vector<std::string>& more = {}) {
    scans.insert(scans.begin(), "pcd2map");
    scans.insert(scans.end(), {"-o", scene(name)});
    scans.insert(scans.end(), more.begin(), more.end());
    ASSERT_EQ(runApp(scans).code, 0);
  }
  static inline std::unique_ptr<TemporaryDirectory> scene_;
};

TEST_F(MergeApp, PartsGiveTheFinestScaleOfTheWhole) {
  const Json said =
      Json::parse(succeed({"merge", scene("a.gmap"), scene("b.gmap"), "-o", own("ab.gmap"), "--exact", "--json"}));
  succeed({"merge", scene("b.gmap"), scene("a.gmap"), "-o", own("ba.gmap")});
  const GaussianMap<3> whole = load(scene("all.gmap"));
  for (const char* const name : {"ab.gmap", "ba.gmap"}) {
    const GaussianMap<3> merged = load(own(name));
    EXPECT_EQ(merged.scale(0).keys, whole.scale(0).keys);
    EXPECT_TRUE(merged.scale(0).moments == whole.scale(0).moments);
  }
  EXPECT_EQ(said["exact"], true);
  EXPECT_EQ(said["maps"], 2);
  EXPECT_EQ(said["points"], whole.weight(0));
  EXPECT_EQ(said["scales"][0]["gaussians"], whole.gaussianCount(0));
  EXPECT_EQ(said["bytes"], std::filesystem::file_size(own("ab.gmap")));
  const Json info = infoOf(own("ab.gmap"));
  EXPECT_EQ(info["takes_scans"], true);
  EXPECT_EQ(info["metadata"]["history"].back()["command"], "merge");
  EXPECT_EQ(info["metadata"]["history"].front()["command"], "pcd2map");
  EXPECT_FALSE(info["metadata"].contains("error_curves"));
  const std::string text = succeed({"merge", scene("a.gmap"), scene("b.gmap"), "-o", own("c.gmap")});
  EXPECT_NE(text.find("c.gmap: 2 maps, "), std::string::npos) << text;
  EXPECT_NE(text.find("exact moments"), std::string::npos) << text;
}

TEST_F(MergeApp, MovesMapsByTheirPoses) {
  succeed({"transform", scene("b.gmap"), "-o", own("moved.gmap"), "--transform", kPose, "--inverse"});
  const std::string text =
      succeed({"merge", scene("a.gmap"), own("moved.gmap"), "-o", own("ab.gmap"), "--transform", kPose});
  EXPECT_NE(text.find("Gaussians only"), std::string::npos) << text;
  std::ofstream(own("poses.txt")) << "moved.gmap " << kPose << '\n';
  succeed({"merge", scene("a.gmap"), own("moved.gmap"), "-o", own("file.gmap"), "--transform-file", own("poses.txt")});
  const GaussianMap<3> merged = load(own("ab.gmap")), whole = load(scene("all.gmap"));
  expectSameMap<3>(merged, load(own("file.gmap")));
  EXPECT_EQ(merged.weight(0), whole.weight(0));
  EXPECT_NEAR(double(merged.cellCount(0)), double(whole.cellCount(0)), 0.01 * double(whole.cellCount(0)));
}

TEST_F(MergeApp, ComesBackFromAnotherFrame) {
  succeed({"transform", scene("plain.gmap"), "-o", own("there.gmap"), "--transform", kPose});
  const Json said = Json::parse(
      succeed({"transform", own("there.gmap"), "-o", own("back.gmap"), "--transform", kPose, "--inverse", "--json"}));
  const GaussianMap<3> map = load(scene("plain.gmap")), back = load(own("back.gmap"));
  EXPECT_EQ(said["scales"][0]["gaussians"], map.gaussianCount(0));
  ASSERT_EQ(back.gaussianCount(0), map.gaussianCount(0));
  for (int s = 0; s < 3; ++s) EXPECT_NEAR(back.weight(s), map.weight(s), 1e-6);
  const Json info = infoOf(own("back.gmap"));
  EXPECT_EQ(info["takes_scans"], false);
  EXPECT_EQ(info["metadata"]["history"].back()["inverse"], true);
}

TEST_F(MergeApp, WidensByTheCovarianceOfThePose) {
  succeed({"transform", scene("plain.gmap"), "-o", own("exact.gmap"), "--transform", kPose});
  succeed({"transform", scene("plain.gmap"), "-o", own("wide.gmap"), "--transform", kPose, "--pose-covariance",
           "0.01 0.01 0.01 0 0 0"});
  const GaussianMap<3> exact = load(own("exact.gmap")), wide = load(own("wide.gmap"));
  for (std::size_t i = 0; i < exact.gaussianCount(0); i += 37)
    ASSERT_LT((wide.gaussian(i, 0).cov - exact.gaussian(i, 0).cov - 0.01 * Matrix<3>::Identity()).norm(), 1e-9);
}

TEST_F(MergeApp, SortsMapsOfOtherCellsOnlyWhenAsked) {
  expectDataError("--resample", {"merge", scene("a.gmap"), scene("coarse.gmap"), "-o", own("x.gmap")});
  succeed({"merge", scene("a.gmap"), scene("coarse.gmap"), "-o", own("x.gmap"), "--resample"});
  EXPECT_EQ(load(own("x.gmap")).options(), load(scene("a.gmap")).options());
  expectUsageError("--exact",
                   {"merge", scene("a.gmap"), scene("coarse.gmap"), "-o", own("y.gmap"), "--resample", "--exact"});
}

TEST_F(MergeApp, RefusesWhatCannotBeMergedExactly) {
  succeed({"transform", scene("a.gmap"), "-o", own("moved.gmap"), "--transform", kPose});
  expectDataError("no exact moments", {"merge", scene("b.gmap"), own("moved.gmap"), "-o", own("x.gmap"), "--exact"});
  expectDataError("no exact moments", {"merge", own("moved.gmap"), scene("b.gmap"), "-o", own("x.gmap"), "--exact"});
  expectUsageError("--exact",
                   {"merge", scene("a.gmap"), scene("b.gmap"), "-o", own("x.gmap"), "--exact", "--transform", kPose});
  succeed({"compress", scene("a.gmap"), "-o", own("small.gmap"), "--max-error", "0.2"});
  expectDataError("compressed", {"merge", scene("b.gmap"), own("small.gmap"), "-o", own("x.gmap")});
  expectDataError("compressed", {"transform", own("small.gmap"), "-o", own("x.gmap"), "--transform", kPose});
}

TEST_F(MergeApp, SaysWhatIsWrongWithAPose) {
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"merge", scene("a.gmap"), scene("b.gmap"), "-o", own("x.gmap")};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expectUsageError("the seven of x y z qx qy qz qw", with({"--transform", "1 2 3"}));
  expectUsageError("'q' is not a number", with({"--transform", "1 2 3 q 0 0 1"}));
  expectUsageError("norm 2", with({"--transform", "1 2 3 0 0 0 2"}));
  expectUsageError("given 2 times for 1 map to move", with({"--transform", kPose, "--transform", kPose}));
  expectUsageError("needs --transform", with({"--pose-covariance", "1 1 1 1 1 1"}));
  expectUsageError("the 36 of a matrix", with({"--transform", kPose, "--pose-covariance", "1 1"}));
  expectDataError("positive semi-definite", with({"--transform", kPose, "--pose-covariance", "1 1 1 1 1 -1"}));
  expectDataError("cannot be opened", with({"--transform-file", own("none.txt")}));
  std::ofstream(own("text.gmap")) << "no map";
  expectDataError("text.gmap", {"merge", scene("a.gmap"), own("text.gmap"), "-o", own("x.gmap")});
  std::ofstream(own("empty.gmap"));
  expectDataError("empty.gmap", {"merge", own("empty.gmap"), scene("a.gmap"), "-o", own("x.gmap")});
  expectUsageError("two maps", {"merge", scene("a.gmap"), "-o", own("x.gmap")});
  expectUsageError("--transform", {"transform", scene("a.gmap"), "-o", own("x.gmap")});
  expectUsageError("destroy the input", {"merge", scene("a.gmap"), scene("b.gmap"), "-o", scene("a.gmap"), "--force"});
}

TEST_F(MergeApp, CropsPartsThatMergeToTheWhole) {
  succeed({"crop", scene("plain.gmap"), "-o", own("in.gmap"), "--box", "-2", "-2", "3", "3"});
  succeed({"crop", scene("plain.gmap"), "-o", own("out.gmap"), "--box", "-2", "-2", "3", "3", "--outside"});
  succeed({"crop", scene("plain.gmap"), "-o", own("polygon.gmap"), "--polygon", "-2", "-2", "3", "-2", "3", "3", "-2",
           "3"});
  succeed({"merge", own("out.gmap"), own("in.gmap"), "-o", own("again.gmap"), "--exact"});
  expectSameMap<3>(load(own("again.gmap")), load(scene("plain.gmap")));
  expectSameMap<3>(load(own("polygon.gmap")), load(own("in.gmap")));
  EXPECT_EQ(infoOf(own("in.gmap"))["metadata"]["history"].back()["box"].size(), 4u);
  expectDataError("no Gaussian lies in",
                  {"crop", scene("plain.gmap"), "-o", own("x.gmap"), "--box", "900", "900", "901", "901"});
  expectUsageError("one of --box and --polygon", {"crop", scene("plain.gmap"), "-o", own("x.gmap")});
  expectUsageError("first corner", {"crop", scene("plain.gmap"), "-o", own("x.gmap"), "--box", "3", "3", "2", "2"});
  expectUsageError("5 numbers found",
                   {"crop", scene("plain.gmap"), "-o", own("x.gmap"), "--box", "1", "2", "3", "4", "5"});
  expectUsageError("three corners",
                   {"crop", scene("plain.gmap"), "-o", own("x.gmap"), "--polygon", "1", "2", "3", "4", "5", "6", "7"});
}

TEST_F(MergeApp, SimplifiesToALimit) {
  const GaussianMap<3> map = load(scene("all.gmap"));
  const auto simplified = [&](const std::vector<std::string>& limit) {
    std::vector<std::string> words = {"simplify", scene("all.gmap"), "-o", own("s.gmap"), "--force"};
    words.insert(words.end(), limit.begin(), limit.end());
    succeed(words);
    return load(own("s.gmap"));
  };
  for (int s = 1; s < 3; ++s) {
    EXPECT_EQ(simplified({"--budget", "1.5"}).gaussianCount(s), map.cellCount(s) * 3 / 2);
    EXPECT_EQ(simplified({"--budget", "1"}).gaussianCount(s), map.cellCount(s));
  }
  const std::string most = std::to_string(map.cellCount(1) + 3);
  EXPECT_EQ(simplified({"--max-gaussians", "1=" + most}).gaussianCount(1), map.cellCount(1) + 3);
  EXPECT_LT(simplified({"--max-error", "0.6"}).gaussianCount(1), map.gaussianCount(1));
  const std::uintmax_t bytes = std::filesystem::file_size(scene("all.gmap")) - 2000;
  simplified({"--max-bytes", std::to_string(bytes)});
  EXPECT_LE(std::filesystem::file_size(own("s.gmap")), bytes);
  EXPECT_EQ(infoOf(own("s.gmap"))["metadata"]["history"].back()["command"], "simplify");
  expectUsageError("one of --budget", {"simplify", scene("all.gmap"), "-o", own("x.gmap")});
  expectUsageError("occupied cells", {"simplify", scene("all.gmap"), "-o", own("x.gmap"), "--max-gaussians", "1"});
  expectDataError("one Gaussian per cell takes",
                  {"simplify", scene("all.gmap"), "-o", own("x.gmap"), "--max-bytes", "1k"});
  const Outcome strict = runApp({"simplify", scene("all.gmap"), "-o", own("s.gmap"), "--force", "--max-error", "1e-6"});
  EXPECT_EQ(strict.code, 0);
  EXPECT_NE(strict.err.find("warning: scale 1 exceeds --max-error"), std::string::npos) << strict.err;
}

}  // namespace
}  // namespace gaussmap::test
