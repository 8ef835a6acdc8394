// SPDX-License-Identifier: BSD-3-Clause
// gaussmap hausdorff as its users meet it: what it compares, what it writes, what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/run_app.h"
#include "evaluation/error_cloud.h"
#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/evaluation/held_out.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/mesh/ply.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/mapping/build.h"
#include "io/files/temporary_directory.h"
#include "mesh/mesh_distance.h"
#include "points/point_clouds.h"

namespace gaussmap {
using namespace detail;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::cube;
using test::Outcome;
using test::Points;
using test::runApp;

TriangleMesh floorMesh() {  // 1 m x 1 m in the plane z = 0
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Two clouds, a mesh and two maps, made once.
class HausdorffApp : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    inputs_ = std::make_unique<test::TemporaryDirectory>();
    a_ = cube(3000, 1);
    b_ = cube(2000, 2, {0.3, 0, 0});
    for (Points* points : {&a_, &b_})
      for (Vector<3>& point : *points)  // as the files hold it
        point = Vector<3>(0.25 + point.x(), point.y(), 0.05 * point.z()).cast<float>().cast<double>();
    writePcd(in("a.pcd"), a_);
    writePcd(in("b.pcd"), b_);
    writePly(in("floor.ply"), floorMesh());
    const MapOptions options{0.1, 4, 2, 0.005};
    save(in("a.gmap"), build<3>(a_, options));
    save(in("b.gmap"), build<3>(b_, options));
    savePcd(in("b_map.pcd"), build<3>(b_, options));
  }
  static void TearDownTestSuite() { inputs_.reset(); }

  static std::string in(const std::string& name) { return (inputs_->path() / name).string(); }
  std::string own(const std::string& name) const { return (directory_.path() / name).string(); }

  static std::string succeed(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "hausdorff");
    const Outcome outcome = runApp(arguments);
    EXPECT_EQ(outcome.code, 0) << testing::PrintToString(arguments) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return outcome.out;
  }
  static Json json(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    return Json::parse(succeed(arguments));
  }
  /// Fails with this code and one line on stderr that holds `word`; makes no file.
  void expectFailure(int code, const std::string& word, std::vector<std::string> arguments) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    arguments.insert(arguments.begin(), "hausdorff");
    const Outcome outcome = runApp(arguments);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.find("gaussmap: "), 0u) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::is_empty(directory_.path()));
  }

  static void expectSummary(const Json& json, const DistanceSummary& expected) {
    EXPECT_EQ(json["max"], expected.max);
    EXPECT_EQ(json["q99"], expected.q99);
    EXPECT_EQ(json["q95"], expected.q95);
    EXPECT_EQ(json["mean"], expected.mean);
    EXPECT_EQ(json["rms"], expected.rms);
    EXPECT_EQ(json["count"], expected.count);
  }
  static void expectResult(const Json& json, const HausdorffResult& expected) {
    expectSummary(json["forward"], expected.forward);
    expectSummary(json["backward"], expected.backward);
    EXPECT_EQ(json["hausdorff"], expected.hausdorff());
  }

  /// The coordinates, errors and colours that --write-errors wrote.
  static void expectErrors(const std::string& file, const Points& points, const std::vector<double>& errors) {
    const PcdReader reader(file);
    ASSERT_EQ(reader.size(), points.size());
    const auto columns = reader.columns({{"x", 0}, {"y", 0}, {"z", 0}, {"error", 0}, {"rgb", 0}});
    const double red = summarise(errors).q99;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        ASSERT_FLOAT_EQ(float(columns[axis][i]), float(points[i](Eigen::Index(axis))));
      ASSERT_FLOAT_EQ(float(columns[3][i]), float(errors[i]));
      const float packed = static_cast<float>(columns[4][i]);
      std::uint32_t colour = 0;
      std::memcpy(&colour, &packed, sizeof colour);
      ASSERT_EQ(colour, errorColour(errors[i], red));
    }
  }

  static SampleOptions samples(std::size_t count) {
    SampleOptions options;
    options.samples = count;
    return options;
  }

  static std::unique_ptr<test::TemporaryDirectory> inputs_;
  static Points a_, b_;
  test::TemporaryDirectory directory_;
};
std::unique_ptr<test::TemporaryDirectory> HausdorffApp::inputs_;
Points HausdorffApp::a_, HausdorffApp::b_;

// ---- what it compares -----------------------------------------------------------------------------------------------

TEST_F(HausdorffApp, ComparesTwoClouds) {
  expectResult(json({in("a.pcd"), in("b.pcd")})["all"], hausdorff(a_, b_));
  const std::string text = succeed({in("a.pcd"), in("b.pcd")});
  EXPECT_NE(text.find("cloud->ref"), std::string::npos) << text;
  EXPECT_NE(text.find("ref->cloud"), std::string::npos) << text;
}

TEST_F(HausdorffApp, FindsTheMaximaOfTwoCloudsAlone) {
  const HausdorffResult expected = hausdorff(a_, b_);
  for (const std::string threads : {"1", "2", "0"}) {
    const Json all = json({in("a.pcd"), in("b.pcd"), "--max-only", "--threads", threads})["all"];
    EXPECT_EQ(all["forward"]["max"], expected.forward.max);
    EXPECT_EQ(all["backward"]["max"], expected.backward.max);
    EXPECT_EQ(all["hausdorff"], expected.hausdorff());
  }
  EXPECT_NE(succeed({in("a.pcd"), in("b.pcd"), "--max-only"}).find("ref->cloud"), std::string::npos);
}

TEST_F(HausdorffApp, ComparesACloudWithAMesh) {
  const Json all = json({in("a.pcd"), in("floor.ply"), "--samples", "500", "--seed", "3"})["all"];
  expectResult(all, Reference(floorMesh(), 500, 3).compare(a_));
  EXPECT_EQ(all["backward"]["count"], 500);
  fs::copy_file(in("floor.ply"), own("FLOOR.PLY"));
  EXPECT_EQ(json({in("a.pcd"), own("FLOOR.PLY"), "--samples", "500", "--seed", "3"})["all"], all);
}

TEST_F(HausdorffApp, ComparesAMapWithAMesh) {
  const GaussianMap<3> map = load(in("a.gmap"));
  const Json scales = json({in("a.gmap"), in("floor.ply"), "--samples", "4000"})["scales"];
  ASSERT_EQ(scales.size(), 2u);
  for (int s = 0; s < 2; ++s) {
    const MapHausdorff expected = Reference(floorMesh(), 4000).compare(map, s, samples(4000));
    expectResult(scales[std::size_t(s)]["all"], expected.all);
    expectResult(scales[std::size_t(s)]["within_two_sigma"], expected.within_two_sigma);
    EXPECT_EQ(scales[std::size_t(s)]["gaussians"], map.gaussianCount(s));
  }
}

TEST_F(HausdorffApp, BoundsSamplesByTheMembersOfTheirGaussiansOrAsInThePaperByCells) {
  const GaussianMap<3> map = load(in("a.gmap"));
  const auto found = [&](std::vector<std::string> options) -> Json {
    options.insert(options.begin(), {in("a.gmap"), in("a.pcd"), "--scale", "1", "--samples", "4000"});
    return json(options)["scales"][0]["all"];
  };
  SampleOptions in_cells = samples(4000);
  in_cells.bounds = SampleBounds::Cell;
  const HausdorffResult cell = evaluateMap(map, 1, a_, in_cells).all,
                        members = evaluateMap(map, 1, a_, samples(4000)).all;
  expectResult(found({"--samples-in", "cell"}), cell);
  expectResult(found({"--samples-in", "members"}), members);
  expectResult(found({}), members);
  EXPECT_NE(members.forward.mean, cell.forward.mean);
  expectFailure(2, "--samples-in", {in("a.gmap"), in("a.pcd"), "--samples-in", "box"});
}

TEST_F(HausdorffApp, ComparesAMapWithAMap) {
  const GaussianMap<3> map = load(in("a.gmap")), other = load(in("b.gmap"));
  const Json scales = json({in("a.gmap"), in("b.gmap"), "--samples", "4000"})["scales"];
  ASSERT_EQ(scales.size(), 2u);
  for (int s = 0; s < 2; ++s) {
    const MapHausdorff expected = Reference(sampleMap(other, s, samples(4000))).compare(map, s, samples(4000));
    expectResult(scales[std::size_t(s)]["all"], expected.all);
    expectResult(scales[std::size_t(s)]["within_two_sigma"], expected.within_two_sigma);
  }
  const Json itself = json({in("a.gmap"), in("a.gmap"), "--samples", "2000", "--scale", "1"})["scales"];
  ASSERT_EQ(itself.size(), 1u);
  EXPECT_EQ(itself[0]["all"]["hausdorff"], 0.0);
  EXPECT_EQ(itself[0]["within_two_sigma"]["hausdorff"], 0.0);
}

TEST_F(HausdorffApp, TakesPcdFilesOfGaussiansAsMapsOnBothSides) {
  const double expected = json({in("a.gmap"), in("b.gmap"), "--scale", "1"})["scales"][0]["all"]["forward"]["mean"];
  const double found = json({in("a.gmap"), in("b_map.pcd"), "--scale", "1"})["scales"][0]["all"]["forward"]["mean"];
  EXPECT_NEAR(found, expected, 0.05 * expected);  // floats, so not the same samples
  EXPECT_EQ(json({in("b_map.pcd"), in("b_map.pcd"), "--scale", "0"})["scales"][0]["all"]["hausdorff"], 0.0);
}

TEST_F(HausdorffApp, PrintsTheSameForAnyNumberOfThreads) {
  for (const std::string reference : {"a.pcd", "floor.ply", "b.gmap"})
    for (const std::string subject : {"b.pcd", "a.gmap"}) {
      if (subject == "b.pcd" && reference == "b.gmap") continue;
      const std::string one = succeed({in(subject), in(reference), "--samples", "2000", "--threads", "1"});
      EXPECT_EQ(one, succeed({in(subject), in(reference), "--samples", "2000", "--threads", "2"}));
      EXPECT_EQ(one, succeed({in(subject), in(reference), "--samples", "2000", "--threads", "0"}));
    }
}

// ---- held-out -------------------------------------------------------------------------------------------------------

TEST_F(HausdorffApp, ScoresAMapWithHeldOutPoints) {
  const GaussianMap<3> map = load(in("a.gmap"));
  const Json result = json({in("a.gmap"), in("b.pcd"), "--held-out", "--background", "0.1"});
  ASSERT_EQ(result["scales"].size(), 2u);
  for (int s = 0; s < 2; ++s) {
    HeldOutOptions options;
    options.background = 0.1;
    const HeldOutResult expected = heldOutLogLikelihood<3>(map, s, b_, options);
    const Json& scale = result["scales"][std::size_t(s)];
    EXPECT_EQ(scale["mean"], expected.mean);
    EXPECT_EQ(scale["median"], expected.median);
    EXPECT_EQ(scale["floor"], expected.floor);
    EXPECT_EQ(scale["volume"], expected.volume);
    EXPECT_EQ(scale["points"], b_.size());
    EXPECT_DOUBLE_EQ(scale["in_no_cell"], double(expected.in_no_cell) / double(b_.size()));
    EXPECT_DOUBLE_EQ(scale["nowhere"], double(expected.nowhere) / double(b_.size()));
  }
  EXPECT_GT(result["scales"][0]["nowhere"], 0.1);  // b reaches 30 cm farther than a
  EXPECT_GT(json({in("b.gmap"), in("b.pcd"), "--held-out"})["scales"][0]["mean"], result["scales"][0]["mean"]);
  EXPECT_NE(succeed({in("a.gmap"), in("b.pcd"), "--held-out"}).find("nowhere"), std::string::npos);
  EXPECT_EQ(json({in("a.gmap"), in("b.pcd"), "--held-out", "--scale", "1"})["scales"].size(), 1u);
}

// ---- --write-errors -------------------------------------------------------------------------------------------------

TEST_F(HausdorffApp, ChecksItsDistancesWithFlann) {
  const auto checked = [](std::vector<std::string> arguments) {
    const Json plain = json(arguments);
    arguments.emplace_back("--check");
    Json with_check = json(arguments);
    const auto count = with_check.at("checked").get<std::size_t>();
    with_check.erase("checked");
    EXPECT_EQ(with_check, plain);  // the report has the same figures
    return count;
  };
  EXPECT_EQ(checked({in("a.pcd"), in("b.pcd")}), 5000u);
  EXPECT_EQ(checked({in("a.pcd"), in("b.pcd"), "--max-only"}), 5000u);
  EXPECT_GT(checked({in("a.gmap"), in("b.pcd"), "--samples", "2000"}), 2u * 2000u);  // two scales
  EXPECT_GT(checked({in("a.gmap"), in("b.gmap"), "--samples", "2000", "--leaves"}), 2000u);
  const std::string text = succeed({in("a.pcd"), in("b.pcd"), "--check"});
  EXPECT_NE(text.find("check: FLANN finds the same 5000 distances\n"), std::string::npos) << text;
  expectFailure(2, "--check: FLANN has no distances to the surface", {in("a.gmap"), in("floor.ply"), "--check"});
  expectFailure(2, "--check", {in("a.gmap"), in("b.pcd"), "--held-out", "--check"});
  const std::string errors = own("checked.pcd");
  succeed({in("a.pcd"), in("b.pcd"), "--check", "--write-errors", errors});
  EXPECT_TRUE(fs::exists(errors));
}

TEST_F(HausdorffApp, WritesTheErrorsOfTheSubject) {
  const Json result = json({in("a.pcd"), in("b.pcd"), "--write-errors", own("errors.pcd")});
  EXPECT_EQ(result["errors"]["points"], a_.size());
  EXPECT_EQ(result["errors"]["direction"], "forward");
  PointDistances distances;
  hausdorff(a_, b_, 0, &distances);
  expectErrors(own("errors.pcd"), a_, distances.forward);

  succeed({in("a.gmap"), in("floor.ply"), "--scale", "1", "--samples", "3000", "--write-errors", own("map.pcd")});
  const Points points = sampleMap(load(in("a.gmap")), 1, samples(3000)).points;
  expectErrors(own("map.pcd"), points, meshDistances(points, floorMesh()));
}

TEST_F(HausdorffApp, WritesTheErrorsOfTheReference) {
  const std::vector<std::string> backward = {"--direction", "backward", "--write-errors", own("errors.pcd"), "--force"};
  const auto write = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), backward.begin(), backward.end());
    EXPECT_NE(succeed(arguments).find(own("errors.pcd")), std::string::npos);
  };
  PointDistances distances;
  write({in("a.pcd"), in("b.pcd")});
  hausdorff(a_, b_, 0, &distances);
  expectErrors(own("errors.pcd"), b_, distances.backward);

  write({in("a.gmap"), in("b.pcd"), "--scale", "0", "--samples", "3000"});
  Reference(b_).compare(load(in("a.gmap")), 0, samples(3000), &distances);
  expectErrors(own("errors.pcd"), b_, distances.backward);

  write({in("a.pcd"), in("floor.ply"), "--samples", "300"});
  const Reference mesh(floorMesh(), 300);
  mesh.compare(a_, 0, &distances);
  expectErrors(own("errors.pcd"), mesh.points(), distances.backward);
}

TEST_F(HausdorffApp, NeverReplacesAFileOfErrorsUnlessForced) {
  std::vector<std::string> arguments = {"hausdorff", in("a.pcd"), in("b.pcd"), "--write-errors", own("errors.pcd")};
  directory_.write("errors.pcd", "mine");
  EXPECT_EQ(runApp(arguments).code, 2);
  EXPECT_EQ(test::contentsOf(own("errors.pcd")), "mine");
  arguments.push_back("--force");
  EXPECT_EQ(runApp(arguments).code, 0);
  EXPECT_EQ(PcdReader(own("errors.pcd")).size(), a_.size());
}

// ---- what it refuses ------------------------------------------------------------------------------------------------

TEST_F(HausdorffApp, RefusesPlacesForTheErrorsThatCannotBe) {
  const auto refuse = [&](const std::string& word, const std::string& file) {
    expectFailure(2, word, {in("a.pcd"), in("b.pcd"), "--write-errors", file, "--force"});
  };
  refuse("destroy the input", in("a.pcd"));
  refuse("destroy the input", in("b.pcd"));
  refuse(".pcd", own("errors.ply"));
  refuse("missing", own("missing/errors.pcd"));
}

TEST_F(HausdorffApp, RefusesOptionsThatDoNotGoTogether) {
  const std::string errors = own("errors.pcd");
  expectFailure(2, "--scale", {in("a.gmap"), in("b.pcd"), "--write-errors", errors});
  expectFailure(2, "--held-out", {in("a.pcd"), in("b.pcd"), "--held-out"});
  expectFailure(2, "--held-out", {in("a.gmap"), in("b.gmap"), "--held-out"});
  expectFailure(2, "--held-out", {in("a.gmap"), in("floor.ply"), "--held-out"});
  expectFailure(2, "--held-out", {in("a.gmap"), in("b.pcd"), "--held-out", "--scale", "0", "--write-errors", errors});
  expectFailure(2, "--max-only", {in("a.gmap"), in("b.pcd"), "--max-only"});
  expectFailure(2, "--max-only", {in("a.pcd"), in("floor.ply"), "--max-only"});
  expectFailure(2, "--max-only", {in("a.pcd"), in("b.pcd"), "--max-only", "--write-errors", errors});
  expectFailure(2, "--direction", {in("a.pcd"), in("b.pcd"), "--direction", "up"});
  for (const char* const value : {"0", "1", "-0.5", "nan", "x"})
    expectFailure(2, "--background", {in("a.gmap"), in("b.pcd"), "--held-out", "--background", value});
}

TEST_F(HausdorffApp, RefusesInputsThatDoNotGoTogether) {
  expectFailure(2, "name the map first", {in("a.pcd"), in("b.gmap")});
  expectFailure(2, "only be the reference", {in("floor.ply"), in("b.pcd")});
  expectFailure(2, "only reference", {in("a.pcd"), in("b.pcd"), in("floor.ply")});
  expectFailure(2, "--poses", {in("a.pcd"), in("floor.ply"), "--poses", in("a.pcd")});
  expectFailure(1, "Gaussians of a map", {in("a.gmap"), in("b.pcd"), in("b_map.pcd")});
  expectFailure(2, "scales 0 to 1", {in("a.gmap"), in("b.gmap"), "--scale", "2"});
}

TEST_F(HausdorffApp, NamesTheMeshThatIsMissingOrDamaged) {
  const std::string bytes = test::contentsOf(in("floor.ply"));
  const test::TemporaryDirectory elsewhere;
  const std::string cut = elsewhere.write("cut.ply", bytes.substr(0, bytes.size() - 5)).string();
  const std::string text = elsewhere.write("text.ply", "hello\n").string();
  const std::string empty = elsewhere.write("empty.ply", "").string();
  for (const std::string& mesh : {cut, text, empty, (elsewhere.path() / "no.ply").string()})
    for (const char* const subject : {"a.pcd", "a.gmap"}) expectFailure(1, mesh + ": ", {in(subject), mesh});
}

}  // namespace
}  // namespace gaussmap
