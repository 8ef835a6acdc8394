// SPDX-License-Identifier: BSD-3-Clause
// gaussmap clean through the real program.
#include <cmath>
#include <cstring>

#include "apps/app_fixture.h"
#include "apps/passing_post.h"
#include "io/pcd/pcd_records.h"

namespace gaussmap::test {
using namespace detail;

namespace {

class CleanApp : public AppTest {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<TemporaryDirectory>();
    writePostScans(*scene_, "scans");
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static std::string scans() { return (scene_->path() / "scans").string(); }
  static std::string scan(int i) { return scans() + "/scan" + std::to_string(i) + ".pcd"; }

  static std::size_t pointsIn(const std::string& path) { return PcdReader(path).size(); }

 private:
  static inline std::unique_ptr<TemporaryDirectory> scene_;
};

TEST_F(CleanApp, LeavesTheScansAsTheyAreWithoutThePost) {
  const std::string said = succeed({"clean", scans(), "-o", own("clean")});
  EXPECT_EQ(said.find("8 scans, 69120 points, "), 0u) << said;
  std::size_t gone = 0;
  for (int i = 0; i < 8; ++i) {
    const std::string name = own("clean/scan" + std::to_string(i) + ".pcd");
    const PcdRecords before = readRecords(PcdReader(scan(i))), after = readRecords(PcdReader(name));
    ASSERT_EQ(after.fields.size(), before.fields.size());
    for (std::size_t f = 0; f < before.fields.size(); ++f) {
      EXPECT_EQ(after.fields[f].name, before.fields[f].name);
      EXPECT_EQ(after.fields[f].type, before.fields[f].type);
      EXPECT_EQ(after.fields[f].size, before.fields[f].size);
      EXPECT_EQ(after.fields[f].count, before.fields[f].count);
    }
    EXPECT_EQ(after.viewpoint.translation, before.viewpoint.translation);
    EXPECT_NEAR(after.viewpoint.translation.y(), 0.1 * i, 1e-12);
    // What is left are the records of before, in their order; what is not is on the post.
    const std::vector<double> labels = PcdReader(scan(i)).column("label");
    std::size_t next = 0;
    for (std::size_t p = 0; p < before.size(); ++p) {
      const char* const record = before.bytes.data() + p * before.record_size;
      if (next < after.size() &&
          std::memcmp(record, after.bytes.data() + next * after.record_size, before.record_size) == 0) {
        ++next;
        continue;
      }
      EXPECT_EQ(labels[p], 1.0) << "point " << p << " of scan " << i;
      ++gone;
    }
    EXPECT_EQ(next, after.size());
  }
  EXPECT_GT(gone, 100u);
}

TEST_F(CleanApp, ScoresAgainstLabels) {
  const std::string text = succeed({"clean", scans(), "--labels"});
  EXPECT_NE(text.find("SA "), std::string::npos) << text;
  EXPECT_NE(text.find(" % of 840 dynamic points removed, AA "), std::string::npos) << text;
  EXPECT_TRUE(ownFiles().empty());

  const Json said = Json::parse(succeed({"clean", scans(), "--labels", "label", "--json"}));
  EXPECT_EQ(said["scans"], 8);
  EXPECT_EQ(said["points"], 69120);
  const Json& score = said["score"];
  EXPECT_EQ(score["static_points"], 69120 - 840);
  EXPECT_EQ(score["dynamic_points"], 840);
  EXPECT_EQ(score["dynamic_removed"].get<int>() + score["static_points"].get<int>() - score["static_kept"].get<int>(),
            said["removed"].get<int>());
  const double sa = score["SA"], da = score["DA"];
  EXPECT_GT(sa, 0.999);
  EXPECT_GT(da, 0.3);
  EXPECT_DOUBLE_EQ(score["AA"], std::sqrt(sa * da));
  EXPECT_FALSE(Json::parse(succeed({"clean", scans(), "-o", own("c"), "--json"})).contains("score"));
}

TEST_F(CleanApp, TakesTheFieldOfLabelsByName) {
  TemporaryDirectory other;
  writePostScans(other, "scans", {false, false, "truth"});
  const std::string folder = (other.path() / "scans").string();
  EXPECT_EQ(Json::parse(succeed({"clean", folder, "--labels", "truth", "--json"}))["score"]["dynamic_points"], 840);
  expectDataError("no field 'label'", {"clean", folder, "-o", own("c"), "--labels"});
}

TEST_F(CleanApp, WritesWhatStaysAndWhatGoesAsCloudsInTheMapFrame) {
  const Json said =
      Json::parse(succeed({"clean", scans(), "--merged", own("still.pcd"), "--removed", own("moving.pcd"), "--json"}));
  const std::size_t gone = said["removed"];
  EXPECT_EQ(pointsIn(own("moving.pcd")), gone);
  EXPECT_EQ(pointsIn(own("still.pcd")), 69120 - gone);
  const PcdReader removed(own("moving.pcd"));
  EXPECT_EQ(removed.header().viewpoint.translation, Eigen::Vector3d(0, 0, 0));
  const auto columns = removed.columns({{"x"}, {"y"}, {"label"}, {"ring", 0}, {"ring", 1}});
  for (std::size_t i = 0; i < gone; ++i) {
    // On the post, wherever it was seen from.
    EXPECT_NEAR(std::hypot(columns[0][i] - 5.0, columns[1][i]), 0.5, 1e-3);
    EXPECT_EQ(columns[2][i], 1.0);
    EXPECT_EQ(columns[3][i] + columns[4][i], 255.0);
  }
}

TEST_F(CleanApp, KeepsOrganisedCloudsInTheirShape) {
  TemporaryDirectory organised;
  writePostScans(organised, "scans", {false, true, "label"});
  const Json said =
      Json::parse(succeed({"clean", (organised.path() / "scans").string(), "-o", own("clean"), "--json"}));
  std::size_t nan = 0;
  for (int i = 0; i < 8; ++i) {
    const PcdReader reader(own("clean/scan" + std::to_string(i) + ".pcd"));
    EXPECT_EQ(reader.header().width, 360u);
    EXPECT_EQ(reader.header().height, 24u);
    const std::vector<double> x = reader.column("x"), numbers = reader.column("intensity");
    nan += static_cast<std::size_t>(std::count_if(x.begin(), x.end(), [](double v) { return std::isnan(v); }));
    for (std::size_t p = 0; p < numbers.size(); ++p) EXPECT_EQ(numbers[p], static_cast<double>(p));
  }
  EXPECT_GT(nan, 100u);
  EXPECT_EQ(said["removed"], nan);
}

TEST_F(CleanApp, RefusesOneScanAlone) {
  expectDataError("scan0.pcd: one cloud alone shows no motion", {"clean", scan(0), "-o", own("clean"), "--json"});
}

TEST_F(CleanApp, TakesTheNoiseOfTheDepths) {
  // The post is 5 m before a wall: no noise of centimetres hides it, but one of metres does.
  const auto removed = [&](const std::string& a, const std::string& b) {
    return Json::parse(succeed({"clean", scans(), "--labels", "--json", "--depth-noise", a, b}))["removed"].get<int>();
  };
  EXPECT_GT(removed("0.01", "0"), 100);
  EXPECT_EQ(removed("0.01", "0.02"), 0);
  expectUsageError("depth-noise", {"clean", scans(), "--labels", "--depth-noise", "0.1"});
  expectUsageError("depth-noise", {"clean", scans(), "--labels", "--depth-noise", "-0.1", "0"});
}

TEST_F(CleanApp, TakesTheConstantsOfItsRules) {
  const auto removed = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"clean", scans(), "--labels", "--json"});
    return Json::parse(succeed(more))["removed"].get<int>();
  };
  const int by_default = removed({});
  ASSERT_GT(by_default, 100);
  EXPECT_EQ(removed({"--hit", "0.85", "--miss", "0.4", "--tolerance", "0.3", "--clearance", "0.35", "--link", "0.2",
                     "--reach", "0.5"}),
            by_default);
  EXPECT_EQ(removed({"--hit", "5"}), 0);  // three hits weigh more than five misses
  EXPECT_EQ(removed({"--miss", "0.1"}), 0);
  EXPECT_EQ(removed({"--tolerance", "7"}), 0);  // no wall is so far behind the post
  EXPECT_EQ(removed({"--clearance", "6"}), 0);
  EXPECT_GT(removed({"--link", "2"}), by_default);
  // With this clearance, the beams free only a part of the post, and the reach finds the rest.
  EXPECT_LT(removed({"--clearance", "3", "--reach", "0"}), removed({"--clearance", "3", "--reach", "2"}));
  for (const std::vector<std::string>& bad : std::vector<std::vector<std::string>>{{"--hit", "0"},
                                                                                   {"--miss", "nan"},
                                                                                   {"--tolerance", "-1"},
                                                                                   {"--clearance", "-1"},
                                                                                   {"--link", "201"},
                                                                                   {"--reach", "-1"}})
    expectUsageError(bad[0], {"clean", scans(), "--labels", bad[0], bad[1]});
}

TEST_F(CleanApp, WritesTheSameBytesOnAnyNumberOfThreads) {
  for (const std::string threads : {"1", "2"})
    succeed({"clean", scans(), "--merged", own(threads + ".pcd"), "--threads", threads});
  EXPECT_EQ(contentsOf(own("1.pcd")), contentsOf(own("2.pcd")));
}

TEST_F(CleanApp, NeverOverwritesItsInputs) {
  const std::string before = contentsOf(scan(0));
  expectUsageError("destroy the input", {"clean", scans(), "-o", scans(), "--force"});
  expectUsageError("destroy the input", {"clean", scans(), "--merged", scan(3), "--force"});
  expectUsageError("destroy the input", {"clean", scans(), "--removed", scan(3), "--force"});
  std::string poses;
  for (int i = 0; i < 8; ++i) poses += std::to_string(i) + " 0 " + std::to_string(0.1 * i) + " 0 0 0 0 1\n";
  const std::string file = directory_.write("poses.tum", poses).string();
  expectUsageError("destroy the input", {"clean", scans(), "--poses", file, "--merged", file, "--force"});
  EXPECT_EQ(contentsOf(scan(0)), before);
  EXPECT_EQ(contentsOf(file), poses);
}

TEST_F(CleanApp, ReplacesOutputsOnlyWhenTold) {
  succeed({"clean", scan(0), scan(1), "-o", own("c"), "--merged", own("m.pcd")});
  expectUsageError("exists already", {"clean", scan(0), scan(1), "-o", own("c")});
  expectUsageError("exists already", {"clean", scan(0), scan(1), "--merged", own("m.pcd")});
  expectUsageError("exists already", {"clean", scan(0), scan(1), "--removed", own("m.pcd")});
  EXPECT_EQ(pointsIn(own("m.pcd")), 2 * pointsIn(scan(0)));
  succeed({"clean", scan(0), scan(1), scan(2), "--merged", own("m.pcd"), "--force"});
  EXPECT_EQ(pointsIn(own("m.pcd")), 3 * pointsIn(scan(0)));
}

TEST_F(CleanApp, RefusesOutputsThatWouldMeet) {
  std::filesystem::create_directories(own("other/scans"));
  std::filesystem::copy_file(scan(1), own("other/scan0.pcd"));
  std::filesystem::copy_file(scan(1), own("other/scans/scan0.pcd"));
  expectUsageError("would both become", {"clean", scan(0), own("other/scans/scan0.pcd"), "-o", own("c")});
  succeed({"clean", scan(0), own("other/scan0.pcd"), "--merged", own("m.pcd")});
  EXPECT_GT(pointsIn(own("m.pcd")), pointsIn(scan(0)));
  expectUsageError("another output", {"clean", scans(), "--merged", own("a.pcd"), "--removed", own("./a.pcd")});
  expectUsageError("another output", {"clean", scans(), "-o", own("c"), "--removed", own("c/scan3.pcd")});
}

TEST_F(CleanApp, WritesTheGivenPoseWhereTheFileHasNone) {
  directory_.write("lost2.pcd", postScan(1, {}));
  std::string lost = postScan(0, {});
  lost.replace(lost.find("VIEWPOINT 0 0.000000 0 1 0 0 0"), 30, "VIEWPOINT 0 0 0 0 0 0 0");
  const std::string path = directory_.write("lost.pcd", lost).string();
  expectDataError("quaternion is zero", {"clean", path, own("lost2.pcd"), "-o", own("c")});
  const std::string poses = directory_.write("poses.tum", "0 7 8 9 0 0 0 1\n1 7 8.1 9 0 0 0 1\n").string();
  succeed({"clean", path, own("lost2.pcd"), "--poses", poses, "-o", own("c")});
  EXPECT_EQ(PcdReader(own("c/lost.pcd")).header().viewpoint.translation, Eigen::Vector3d(7, 8, 9));
}

TEST_F(CleanApp, SaysWhatIsWrong) {
  expectUsageError("nothing to do", {"clean", scans()});
  expectUsageError("nothing to do", {"clean", scans(), "--json"});
  expectUsageError("scans", {"clean", "-o", own("c")});
  for (const std::string bad : {"0", "-1", "nan", "wide"}) {
    expectUsageError("resolution", {"clean", scans(), "-o", own("c"), "--resolution", bad});
    expectUsageError("no-return-is-free", {"clean", scans(), "-o", own("c"), "--no-return-is-free", bad});
  }
  expectDataError("no field 'class'", {"clean", scans(), "-o", own("c"), "--labels", "class"});
  expectDataError("none.pcd", {"clean", own("none.pcd"), "-o", own("c")});
  std::string odd = postScan(1, {});  // numbers of three bytes: what cannot be written is told before any work
  odd.replace(odd.find("SIZE 4 4 4 2 4 1"), 16, "SIZE 4 4 4 3 3 1");
  const std::string odd_path = directory_.write("odd.pcd", odd).string();
  expectDataError("odd.pcd: PCD field 'intensity'", {"clean", scan(0), odd_path, "-o", own("c")});
  EXPECT_FALSE(std::filesystem::exists(own("c/scan0.pcd")));
  const std::string bare = directory_.write("bare.pcd", xyzHeader(1, "binary") + std::string(12, '\1')).string();
  const Outcome other = runApp({"clean", scan(0), bare, "--merged", own("m.pcd")});
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.err.find("other fields"), std::string::npos) << other.err;
  EXPECT_FALSE(std::filesystem::exists(own("m.pcd")));
}

}  // namespace
}  // namespace gaussmap::test
