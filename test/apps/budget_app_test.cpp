// SPDX-License-Identifier: BSD-3-Clause
// Budgets and error curves through the real program.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/run_app.h"
#include "io/temporary_directory.h"

namespace gaussmap::test {
namespace {

using Json = nlohmann::json;

class BudgetApps : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(runApp({"simulate", "-o", scene(""), "--columns", "200"}).code, 0);
    ASSERT_EQ(runApp({"pcd2map", scene("scans"), "-o", scene("one.gmap"), "--budget", "1"}).code, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string scene(const std::string& name) { return (folder_->path() / name).string(); }
  std::string own(const std::string& name) const { return (directory_.path() / name).string(); }
  static Json infoOf(const std::string& map) { return Json::parse(runApp({"info", map, "--json"}).out); }

  /// refine of the unrefined map with some options.
  Outcome refineWith(const std::string& out, std::vector<std::string> options) {
    options.insert(options.begin(), {"refine", scene("one.gmap"), "-o", own(out)});
    return runApp(options);
  }

  static std::unique_ptr<TemporaryDirectory> folder_;
  TemporaryDirectory directory_;
};
std::unique_ptr<TemporaryDirectory> BudgetApps::folder_;

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

TEST_F(BudgetApps, StillKnowTheMethodOfThePaper) {
  ASSERT_EQ(refineWith("insert.gmap", {"--method", "insert", "--budget", "2"}).code, 0);
  ASSERT_EQ(refineWith("agglomerate.gmap", {"--budget", "2"}).code, 0);
  EXPECT_EQ(infoOf(own("insert.gmap"))["scales"][1]["gaussians"],
            infoOf(own("agglomerate.gmap"))["scales"][1]["gaussians"]);
  EXPECT_NE(contentsOf(own("insert.gmap")), contentsOf(own("agglomerate.gmap")));
}

}  // namespace
}  // namespace gaussmap::test
