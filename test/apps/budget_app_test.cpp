// SPDX-License-Identifier: BSD-3-Clause
// Budgets and error curves through the real program.
#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/version.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

class BudgetApps : public AppTest {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(runApp({"simulate", "-o", scene(""), "--columns", "200"}).code, 0);
    ASSERT_EQ(runApp({"pcd2map", scene("scans"), "-o", scene("one.gmap"), "--budget", "1"}).code, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string scene(const std::string& name) { return (folder_->path() / name).string(); }

  /// refine of the unrefined map with some options.
  Outcome refineWith(const std::string& out, std::vector<std::string> options) {
    options.insert(options.begin(), {"refine", scene("one.gmap"), "-o", own(out)});
    return runApp(options);
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> folder_;
};

TEST_F(BudgetApps, KeepToTheGaussiansAllowedForAllScalesAndForOne) {
  const int cells = infoOf(scene("one.gmap"))["scales"][1]["cells"];
  ASSERT_EQ(refineWith("a.gmap", {"--max-gaussians", std::to_string(2 * cells), "--max-gaussians", "2=30"}).code, 0);
  const Json scales = infoOf(own("a.gmap"))["scales"];
  EXPECT_EQ(scales[1]["gaussians"], 2 * cells);
  EXPECT_EQ(scales[2]["gaussians"], 30);
}

TEST_F(BudgetApps, KeepToTheBytesAllowed) {
  const std::uintmax_t least = infoOf(scene("one.gmap"))["bytes"];
  for (const std::uintmax_t most : {least + 20000, least + 60000}) {
    const std::string name = std::to_string(most) + ".gmap";
    ASSERT_EQ(refineWith(name, {"--max-bytes", std::to_string(most)}).code, 0);
    EXPECT_LE(std::filesystem::file_size(own(name)), most);
    EXPECT_GT(std::filesystem::file_size(own(name)), least);
  }
  EXPECT_EQ(refineWith("no.gmap", {"--max-bytes", "1k"}).code, 1);
  EXPECT_FALSE(std::filesystem::exists(own("no.gmap")));
}

TEST_F(BudgetApps, ReachTheErrorAskedForOrWarn) {
  const Outcome easy = refineWith("easy.gmap", {"--max-error", "0.8"}),
                hard = refineWith("hard.gmap", {"--max-error", "0.001"});
  EXPECT_EQ(easy.code, 0);
  EXPECT_EQ(easy.err, "");
  EXPECT_EQ(hard.code, 0);
  EXPECT_NE(hard.err.find("does not reach --max-error"), std::string::npos) << hard.err;
  EXPECT_LT(infoOf(own("easy.gmap"))["scales"][2]["gaussians"], infoOf(own("hard.gmap"))["scales"][2]["gaussians"]);
}

TEST_F(BudgetApps, TakeOneBudgetOnly) {
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--budget", "2", "--max-gaussians", "9999"},
                                                  {"--max-bytes", "1M", "--max-error", "1"},
                                                  {"--max-bytes", "12Q"},
                                                  {"--max-bytes", "0"},
                                                  {"--max-gaussians", "10"},
                                                  {"--max-gaussians", "0=99999"},
                                                  {"--max-gaussians", "x"},
                                                  {"--max-error", "-1"},
                                                  {"--method", "insert", "--max-error", "1"},
                                                  {"--method", "other"}}) {
    const Outcome outcome = refineWith("x.gmap", options);
    EXPECT_EQ(outcome.code, 2) << testing::PrintToString(options);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(own("x.gmap")));
  }
}

/// What the commands write comes from the library.
TEST_F(BudgetApps, WriteTheBytesThatACallOfTheLibraryWrites) {
  const auto sameAs = [&](const std::string& name, const Budget& budget, bool curves, const std::string& details) {
    MapMetadata metadata = loadMetadata(scene("one.gmap"));
    RefineOptions options;
    if (curves) options.curves.emplace();
    recordStep(metadata, refineStep(budget, options, details));
    const auto* bytes = std::get_if<MaxBytes>(&budget);
    const Budget measured = bytes != nullptr ? Budget(maxFileBytes(bytes->bytes, metadata)) : budget;
    save(own("library.gmap"), refine(load(scene("one.gmap")), measured, options), metadata, {true});
    return contentsOf(own("library.gmap")) == contentsOf(own(name));
  };
  const std::string command = R"({"command": "refine", "version": ")" GAUSSMAP_VERSION R"("})";
  ASSERT_EQ(refineWith("budget.gmap", {"--budget", "2"}).code, 0);
  EXPECT_TRUE(sameAs("budget.gmap", PerCell{2.0}, true, command));
  ASSERT_EQ(refineWith("error.gmap", {"--max-error", "0.8"}).code, 0);
  EXPECT_TRUE(sameAs("error.gmap", MaxError{0.8, {}}, true, command));
  const std::uintmax_t most = infoOf(scene("one.gmap"))["bytes"].get<std::uintmax_t>() + 30000;
  ASSERT_EQ(refineWith("bytes.gmap", {"--max-bytes", std::to_string(most)}).code, 0);
  EXPECT_TRUE(sameAs("bytes.gmap", MaxBytes{most, {}}, true, command));
}

TEST_F(BudgetApps, KeepTheErrorCurvesAndDrawThem) {
  ASSERT_EQ(refineWith("a.gmap", {"--budget", "2"}).code, 0);
  const Json curves = infoOf(own("a.gmap"))["metadata"]["error_curves"];
  ASSERT_EQ(curves.size(), 2u);
  const Json points = curves[1]["points"];
  EXPECT_LT(points.back()["mean"], points.front()["mean"]);
  ASSERT_EQ(runApp({"info", own("a.gmap"), "--plot", own("curve.svg")}).code, 0);
  const std::string svg = contentsOf(own("curve.svg"));
  EXPECT_EQ(svg.find("<svg"), 0u);
  EXPECT_NE(svg.find("scale 2, 95 %"), std::string::npos);
  EXPECT_EQ(runApp({"info", own("a.gmap"), "--plot", own("curve.svg")}).code, 2) << "an existing plot is kept";
  EXPECT_EQ(runApp({"info", scene("one.gmap"), "--plot", own("none.svg")}).code, 1) << "no curve to draw";
}

TEST_F(BudgetApps, TakeErrorCurvesThatAreNoneForNone) {
  const GaussianMapOctree map = load(scene("one.gmap"));
  const std::string points = R"([{"scale":1,"points":[{"gaussians":GAUSSIANS,"q95":Q95,"mean":0.1}]}])";
  const auto curve = [&](const std::string& gaussians, const std::string& q95) {
    std::string text = points;
    text.replace(text.find("GAUSSIANS"), 9, gaussians);
    return text.replace(text.find("Q95"), 3, q95);
  };
  const std::vector<std::string> none = {"",
                                         R"({"scale":1})",
                                         "[1]",
                                         R"([{"scale":1,"points":[]}])",
                                         R"([{"points":[]}])",
                                         curve("0", "0.2"),
                                         curve("-3", "0.2"),
                                         "[",
                                         curve("3", "null"),
                                         curve("1e999", "0.2"),
                                         curve("\"3\"", "0.2")};
  for (const std::string& text : none) {
    save(own("lying.gmap"), map, {{"error_curves", text}}, {true, 3, 0});
    EXPECT_EQ(runApp({"info", own("lying.gmap")}).code, 0) << text;
    const Outcome plot = runApp({"info", own("lying.gmap"), "--plot", own("lying.svg")});
    EXPECT_EQ(plot.code, 1) << text;
    EXPECT_NE(plot.err.find("has no error curves"), std::string::npos) << text << ": " << plot.err;
    EXPECT_FALSE(std::filesystem::exists(own("lying.svg")));
  }
  save(own("lying.gmap"), map, {{"error_curves", curve("3", "0.2")}}, {true, 3, 0});
  EXPECT_EQ(runApp({"info", own("lying.gmap"), "--plot", own("honest.svg")}).code, 0);
}

TEST_F(BudgetApps, StillKnowTheMethodOfThePaper) {
  ASSERT_EQ(refineWith("insert.gmap", {"--method", "insert", "--budget", "2"}).code, 0);
  ASSERT_EQ(refineWith("agglomerate.gmap", {"--budget", "2"}).code, 0);
  EXPECT_EQ(infoOf(own("insert.gmap"))["scales"][1]["gaussians"],
            infoOf(own("agglomerate.gmap"))["scales"][1]["gaussians"]);
  EXPECT_NE(contentsOf(own("insert.gmap")), contentsOf(own("agglomerate.gmap")));
}

TEST_F(BudgetApps, MergeByTheCostAskedFor) {
  const auto refined = [&](const std::string& name, const std::vector<std::string>& options) {
    const Outcome outcome = refineWith(name, options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return load(own(name));
  };
  const GaussianMapOctree usual = refined("usual.gmap", {}), volume = refined("volume.gmap", {"--cost", "volume"}),
                          runnalls = refined("runnalls.gmap", {"--cost", "runnalls"});
  expectSameMap<3>(volume, usual);
  EXPECT_FALSE(sameMap<3>(runnalls, usual));
  EXPECT_EQ(runnalls.gaussianCount(1), usual.gaussianCount(1));
  EXPECT_EQ(infoOf(own("runnalls.gmap"))["metadata"]["history"][1]["cost"], "runnalls");
  succeed({"pcd2map", scene("scans"), "-o", own("direct.gmap"), "--cost", "runnalls"});
  expectSameMap<3>(load(own("direct.gmap")), runnalls);
}

TEST_F(BudgetApps, RefuseOptionsOfTheOtherMethod) {
  for (const std::string command : {"refine", "pcd2map"}) {
    const std::string input = scene(command == "refine" ? "one.gmap" : "scans");
    const auto refuse = [&](const std::string& word, std::vector<std::string> options) {
      options.insert(options.begin(), {command, input, "-o", own("x.gmap")});
      expectUsageError(word, options);
    };
    refuse("--cost: only for --method agglomerate", {"--method", "insert", "--cost", "volume"});
    refuse("--cost", {"--cost", "area"});
    refuse("--distance: only for --method insert", {"--distance", "kl"});
    refuse("--distance: only for --method insert", {"--distance", "wasserstein", "--method", "agglomerate"});
    refuse("--distance", {"--distance", "euclid", "--method", "insert"});
    refuse("--distance", {"--distance", "--method", "insert"});
  }
  expectUsageError("--distance: not with --online", {"pcd2map", scene("scans"), "-o", own("x.gmap"), "--online",
                                                     "--method", "insert", "--distance", "bhattacharyya"});
}

TEST_F(BudgetApps, InsertByTheDistanceAskedFor) {
  const auto refined = [&](const std::string& name, std::vector<std::string> options) {
    options.insert(options.end(), {"--method", "insert", "--budget", "2"});
    const Outcome outcome = refineWith(name, options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return load(own(name));
  };
  const GaussianMapOctree usual = refined("usual.gmap", {});
  expectSameMap<3>(refined("kl.gmap", {"--distance", "kl"}), usual);
  EXPECT_FALSE(infoOf(own("kl.gmap"))["metadata"]["history"][1].contains("distance"));
  std::vector<GaussianMapOctree> maps = {usual};
  const std::pair<const char*, GaussianDistance> others[] = {{"symmetric-kl", GaussianDistance::SymmetricKL},
                                                             {"bhattacharyya", GaussianDistance::Bhattacharyya},
                                                             {"wasserstein", GaussianDistance::Wasserstein}};
  for (const auto& [word, distance] : others) {
    const std::string name = std::string(word) + ".gmap";
    const GaussianMapOctree map = refined(name, {"--distance", word});
    EXPECT_EQ(infoOf(own(name))["metadata"]["history"][1]["distance"], word);
    RefineOptions options;
    options.method = RefineMethod::Insert;
    options.distance = distance;
    expectSameMap<3>(map, refine(load(scene("one.gmap")), PerCell{2.0}, options).map);
    for (const GaussianMapOctree& other : maps) EXPECT_FALSE(sameMap<3>(map, other)) << word;
    maps.push_back(map);
  }
  succeed({"pcd2map", scene("scans"), "-o", own("direct.gmap"), "--method", "insert", "--budget", "2", "--distance",
           "wasserstein"});
  expectSameMap<3>(load(own("direct.gmap")), maps.back());
}

}  // namespace
}  // namespace gaussmap::test
