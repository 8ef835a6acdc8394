// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/gmap/map_file.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "gaussmap/mapping/build.h"
#include "io/files/temporary_directory.h"
#include "io/gmap/map_equality.h"
#include "map/random_clouds.h"

namespace gaussmap::test {
namespace {

GaussianMapOctree smallCloudMap() {
  return build<3>(randomCloud<3>(2000, 3), {0.1, 4, 3, 0.0});
}

/// Curves of few samples.
RefineOptions quickCurves() {
  RefineOptions options;
  options.curves.emplace();
  options.curves->sampling.samples = 500;
  options.curves->sampling.data = 1000;
  return options;
}

TEST(MapHistory, TellsTheMethodAndTheBudgetOfARefinement) {
  EXPECT_EQ(refineStep(PerCell{2.5}), R"({"method":"agglomerate","budget":2.5})");
  EXPECT_EQ(refineStep(MaxGaussians{{{1, 4000}, {2, 30}}}),
            R"({"method":"agglomerate","max_gaussians":["1=4000","2=30"]})");
  EXPECT_EQ(refineStep(maxFileBytes(9000000)), R"({"method":"agglomerate","max_bytes":9000000})");
  EXPECT_EQ(refineStep(MaxError{0.25, {}}), R"({"method":"agglomerate","max_error":0.25})");
  EXPECT_EQ(refineStep(PerCell{}, RefineOptions::yguel2009()),
            R"({"method":"insert","budget":3.0,"seed":0,"queue":4,"seed_rule":"datum","only_occupied":true,)"
            R"("learning_factor":true})");
  RefineOptions options;
  options.distance = GaussianDistance::Bhattacharyya;
  EXPECT_EQ(refineStep(PerCell{2.5}, options), R"({"method":"agglomerate","budget":2.5})");
  options.method = RefineMethod::Insert;
  EXPECT_EQ(refineStep(PerCell{2.5}, options),
            R"({"method":"insert","budget":2.5,"seed":0,"distance":"bhattacharyya"})");
}

TEST(MapHistory, TellsTheBudgetOfASimplification) {
  EXPECT_EQ(simplifyStep(PerCell{2.0}), R"({"budget":2.0})");
  EXPECT_EQ(simplifyStep(MaxError{0.5, {}}, {MergeCost::Runnalls, 0}), R"({"cost":"runnalls","max_error":0.5})");
  EXPECT_EQ(simplifyStep(PerCell{2.0}, SimplifyOptions::yguel2009()), R"({"cost":"kl","budget":2.0,"smooth":true})");
}

TEST(MapHistory, TakesDetailsThatReplaceItsOwn) {
  EXPECT_EQ(refineStep(PerCell{2.0}, {}, R"({"command": "refine", "budget": "two"})"),
            R"({"command":"refine","method":"agglomerate","budget":"two"})");
  EXPECT_THROW(refineStep(PerCell{}, {}, "[]"), std::invalid_argument);
  EXPECT_THROW(simplifyStep(PerCell{}, {}, "not JSON"), std::invalid_argument);
}

TEST(MapHistory, KeepsTheOrderOfTheDetails) {
  EXPECT_EQ(refineStep(PerCell{2.0}, {}, R"({"z": 1, "cost": "volume", "a": 2})"),
            R"({"z":1,"a":2,"method":"agglomerate","cost":"volume","budget":2.0})");
}

TEST(MapHistory, GrowsStepByStep) {
  MapMetadata metadata = {{"note", "kept"}};
  recordStep(metadata, R"({"a": 1})");
  recordStep(metadata, R"({"b": 2})");
  EXPECT_EQ(metadata[kHistoryEntry], R"([{"a":1},{"b":2}])");
  EXPECT_EQ(metadata["note"], "kept");
  EXPECT_THROW(recordStep(metadata, "3"), std::invalid_argument);
  metadata[kHistoryEntry] = "damaged";
  recordStep(metadata, R"({"c": 3})");
  EXPECT_EQ(metadata[kHistoryEntry], R"([{"c":3}])");
}

TEST(MapHistory, KeepsCurvesAndRemovesThoseOfAnOlderMap) {
  MapMetadata metadata;
  recordCurves(metadata, {{1, {{10, 0.5, 0.25, 0.125}}}});
  EXPECT_EQ(metadata[kCurvesEntry], R"([{"scale":1,"points":[{"gaussians":10,"q99":0.5,"q95":0.25,"mean":0.125}]}])");
  recordCurves(metadata, {});
  EXPECT_EQ(metadata.count(kCurvesEntry), 0u);
}

TEST(MapHistory, SavesAResultWithItsCurves) {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder.path() / "map.gmap";
  const Budget budget = PerCell{2.0};
  const RefineResult<3> result = refine(smallCloudMap(), budget, quickCurves());
  MapMetadata metadata;
  recordStep(metadata, refineStep(budget, quickCurves()));
  save(path, result, metadata);
  expectSameMap<3>(load(path), result.map);
  MapMetadata expected = metadata;
  recordCurves(expected, result.curves);
  EXPECT_EQ(loadMetadata(path), expected);
  EXPECT_EQ(std::filesystem::file_size(path), savedSize(result, metadata));
}

TEST(MaxFileBytes, BoundTheFileWithItsMetadata) {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder.path() / "map.gmap";
  const GaussianMapOctree map = smallCloudMap();
  const MapMetadata metadata = {{"note", std::string(20000, 'x')}};
  const std::uintmax_t most = savedSize<3>(map, metadata) + 20000;
  for (const bool curves : {false, true}) {
    const RefineResult<3> result = refine(map, maxFileBytes(most, metadata), curves ? quickCurves() : RefineOptions());
    save(path, result, metadata, {true});
    EXPECT_LE(std::filesystem::file_size(path), most);
    EXPECT_GT(result.map.gaussianCount(1), map.cellCount(1));
  }
}

}  // namespace
}  // namespace gaussmap::test
