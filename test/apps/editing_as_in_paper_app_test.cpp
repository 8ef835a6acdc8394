// SPDX-License-Identifier: BSD-3-Clause
// --as-in-paper of refine, merge, simplify, compress and hausdorff, through the real program.
#include "apps/planar_fixture.h"
#include "gaussmap/editing/compress.h"
#include "gaussmap/editing/merge_maps.h"
#include "gaussmap/editing/simplify.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/refine.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

/// Planar maps and 3-D maps of the same scans: "left" and "right" overlap, "all" is both.
class EditingAsInPaper : public PlanarApps {
 protected:
  static void SetUpTestSuite() {
    PlanarApps::SetUpTestSuite();
    for (const bool is_planar : {true, false}) {
      const Words build = is_planar ? planar({}) : Words{"pcd2map", "--resolution", "0.1"};
      for (const bool is_left : {true, false}) {
        Words scans;
        for (int i = is_left ? 0 : kScans / 2; i < (is_left ? kScans / 2 + 2 : kScans); ++i)
          scans.push_back(scanFile(i));
        ASSERT_EQ(runApp(joined(build, joined(scans, {"-o", input(is_planar, is_left ? "left" : "right")}))).code, 0);
      }
      ASSERT_EQ(runApp(joined(build, {world("pcd"), "-o", input(is_planar, "all")})).code, 0);
    }
  }
  static std::string scanFile(int i) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(world("pcd"))) names.push_back(entry.path().string());
    std::sort(names.begin(), names.end());
    return names.at(static_cast<std::size_t>(i));
  }
  static std::string input(bool is_planar, const std::string& name) {
    return world((is_planar ? "planar_" : "space_") + name + ".gmap");
  }
  /// Runs a command that writes out.gmap, and returns its last step in the history.
  Json stepOf(const Words& words) const {
    succeed(joined(words, {"-o", own("out.gmap"), "--force"}));
    return infoOf(own("out.gmap"))["metadata"]["history"].back();
  }
  template <int D>
  GaussianMap<D> out() const {
    return gaussmap::load<D>(own("out.gmap"));
  }
  template <int D>
  static GaussianMap<D> load(const std::string& name) {
    return gaussmap::load<D>(input(D == 2, name));
  }
  static std::string name(int dimensions, const std::string& map) { return input(dimensions == 2, map); }

  template <int D>
  void refines() const {
    const Json step = stepOf({"refine", name(D, "all"), "--as-in-paper", "--budget", "2"});
    EXPECT_EQ(step["as_in_paper"], true);
    EXPECT_EQ(step["method"], "insert");
    EXPECT_EQ(step["queue"], 4);
    EXPECT_EQ(step["seed_rule"], "datum");
    EXPECT_EQ(step["only_occupied"], true);
    EXPECT_EQ(step["learning_factor"], true);
    expectSameMap<D>(out<D>(), refine<D>(load<D>("all"), PerCell{2.0}, RefineOptions::yguel2009()).map);
    // An option that is given replaces the setting.
    const Json other = stepOf({"refine", name(D, "all"), "--as-in-paper", "--budget", "2", "--queue", "9",
                               "--seed-rule", "parent", "--max-swaps", "1"});
    EXPECT_EQ(other["queue"], 9);
    EXPECT_EQ(other["max_swaps"], 1);
    EXPECT_FALSE(other.contains("seed_rule"));
    RefineOptions options = RefineOptions::yguel2009();
    options.queue = 9;
    options.max_swaps = 1;
    options.seed_rule = ClusterSeed::ParentCovariance;
    expectSameMap<D>(out<D>(), refine<D>(load<D>("all"), PerCell{2.0}, options).map);
  }

  template <int D>
  void merges() const {
    const Json step = stepOf({"merge", name(D, "left"), name(D, "right"), "--as-in-paper"});
    EXPECT_EQ(step["as_in_paper"], true);
    EXPECT_EQ(step["merge_method"], "clusters");
    EXPECT_EQ(step["cost"], "kl");
    EXPECT_EQ(step["smooth"], true);
    EXPECT_EQ(step["exact"], true);
    const GaussianMap<D> left = load<D>("left"), right = load<D>("right");
    MergeMapsOptions options = MergeMapsOptions::yguel2009();
    expectSameMap<D>(out<D>(), mergeMaps<D>(left, right, options));
    stepOf({"merge", name(D, "left"), name(D, "right"), "--as-in-paper", "--cost", "runnalls", "--smooth=false",
            "--method", "finer-scales"});
    options = {};
    options.merge_cost = MergeCost::Runnalls;
    expectSameMap<D>(out<D>(), mergeMaps<D>(left, right, options));
    const Json usual = stepOf({"merge", name(D, "left"), name(D, "right")});
    for (const char* const member : {"as_in_paper", "merge_method", "cost", "smooth"})
      EXPECT_FALSE(usual.contains(member)) << member;
  }

  template <int D>
  void simplifies() const {
    const Json step = stepOf({"simplify", name(D, "all"), "--as-in-paper", "--budget", "1.5"});
    EXPECT_EQ(step["as_in_paper"], true);
    EXPECT_EQ(step["cost"], "kl");
    EXPECT_EQ(step["smooth"], true);
    SimplifyOptions options = SimplifyOptions::yguel2009();
    expectSameMap<D>(out<D>(), simplify<D>(load<D>("all"), PerCell{1.5}, options).map);
    stepOf({"simplify", name(D, "all"), "--budget", "1.5", "--cost", "kl"});
    options.smooth = false;
    expectSameMap<D>(out<D>(), simplify<D>(load<D>("all"), PerCell{1.5}, options).map);
  }

  template <int D>
  void compresses() const {
    const Json step = stepOf({"compress", name(D, "all"), "--as-in-paper", "--max-cell-error", "20"});
    EXPECT_EQ(step["as_in_paper"], true);
    EXPECT_EQ(step["max_cell_error"], 20.0);
    EXPECT_EQ(step["learning_factor"], true);
    EXPECT_FALSE(step.contains("max_error"));
    const GaussianMap<D> small = out<D>();
    EXPECT_TRUE(small.isCompressed());
    EXPECT_GT(small.cellCount(0), 0u);
    expectSameMap<D>(small, compress<D>(load<D>("all"), 20.0, CompressOptions::yguel2009()));
    // Compressed maps can be merged now.
    succeed({"compress", name(D, "left"), "-o", own("left.gmap"), "--force", "--max-cell-error", "20"});
    stepOf({"merge", own("left.gmap"), name(D, "right"), "--as-in-paper"});
    EXPECT_TRUE(out<D>().isCompressed());
    EXPECT_NEAR(out<D>().weight(2), load<D>("left").weight(2) + load<D>("right").weight(2), 1e-6);
  }
};

TEST_F(EditingAsInPaper, RefineInsertsAsPrinted) {
  refines<2>();
  refines<3>();
}
TEST_F(EditingAsInPaper, MergeUnitesClustersAsPrinted) {
  merges<2>();
  merges<3>();
}
TEST_F(EditingAsInPaper, SimplifyUnitesClustersAsPrinted) {
  simplifies<2>();
  simplifies<3>();
}
TEST_F(EditingAsInPaper, CompressComparesEquationSix) {
  compresses<2>();
  compresses<3>();
}

TEST_F(EditingAsInPaper, Pcd2mapTakesTheSettingsOfTheInsertion) {
  succeed(planar({world("pcd"), "-o", own("out.gmap"), "--method", "insert", "--queue", "4", "--seed-rule", "datum",
                  "--only-occupied", "--learning-factor", "--budget", "2"}));
  expectSameMap<2>(out<2>(), refine<2>(load<2>("all"), PerCell{2.0}, RefineOptions::yguel2009()).map);
}

TEST_F(EditingAsInPaper, HausdorffSamplesTheCellsAsPrinted) {
  const auto errors = [&](const Words& more) {
    return Json::parse(succeed(
        joined({"hausdorff", room(), world("pcd"), "--scale", "1", "--samples", "500", "--json"}, more)))["scales"];
  };
  const Json paper = errors({"--as-in-paper"});
  EXPECT_EQ(paper, errors({"--samples-in", "cell", "--at-least", "0"}));
  EXPECT_NE(paper, errors({"--samples-in", "cell"}));
  EXPECT_NE(paper, errors({"--at-least", "0"}));
  EXPECT_EQ(errors({"--as-in-paper", "--samples-in", "members", "--at-least", "30"}), errors({}));
}

TEST_F(EditingAsInPaper, SaysWhatDoesNotFit) {
  const std::string map = input(true, "all"), left = input(true, "left");
  expectUsageError("--max-cell-error", {"compress", map, "-o", own("x.gmap"), "--as-in-paper"});
  expectUsageError("not with --as-in-paper",
                   {"compress", map, "-o", own("x.gmap"), "--as-in-paper", "--max-error", "0.1"});
  expectUsageError("--max-error or --max-cell-error", {"compress", map, "-o", own("x.gmap")});
  expectUsageError("--max-cell-error",
                   {"compress", map, "-o", own("x.gmap"), "--max-error", "0.1", "--max-cell-error", "9"});
  expectUsageError("--learning-factor",
                   {"compress", map, "-o", own("x.gmap"), "--max-error", "0.1", "--learning-factor"});
  for (const Words& option : {Words{"--queue", "4"},
                              {"--max-swaps", "3"},
                              {"--seed-rule", "datum"},
                              {"--only-occupied"},
                              {"--learning-factor"}})
    expectUsageError(option.front() + ": only for --method insert",
                     joined({"refine", map, "-o", own("x.gmap")}, option));
  expectUsageError("--queue: not with --online",
                   planar({world("pcd"), "-o", own("x.gmap"), "--online", "--method", "insert", "--queue", "4"}));
  expectUsageError("--queue", {"pcd2map", world("pcd"), "--update", map, "--queue", "4"});
  expectUsageError("supports only --budget",
                   {"refine", map, "-o", own("x.gmap"), "--as-in-paper", "--max-error", "0.1"});
  expectUsageError("one of --budget", {"simplify", map, "-o", own("x.gmap"), "--as-in-paper"});
  succeed({"compress", left, "-o", own("small.gmap"), "--max-cell-error", "1e6"});
  expectDataError("--method clusters", {"merge", own("small.gmap"), map, "-o", own("x.gmap")});
}

}  // namespace
}  // namespace gaussmap::test
