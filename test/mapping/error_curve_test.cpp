// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/refine.h"

#include <gtest/gtest.h>

#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/build.h"
#include "io/files/temporary_directory.h"
#include "map/random_clouds.h"
#include "mapping/room.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

GaussianMapOctree cloudMap(std::uint64_t seed) {
  return build<3>(test::randomCloud<3>(4000, seed), {0.1, 5, 3, 0.0});
}

ErrorSampling quickSampling() {
  ErrorSampling sampling;
  sampling.samples = 2000;
  sampling.data = 5000;
  return sampling;
}

/// Few samples, for the curves of refine().
CurveOptions quick() {
  CurveOptions curves;
  curves.sampling = quickSampling();
  return curves;
}

RefineOptions withCurves(const CurveOptions& curves) {
  RefineOptions options;
  options.curves = curves;
  return options;
}

/// As many Gaussians at the coarse scales as a map has.
MaxGaussians asManyAs(const GaussianMapOctree& map) {
  MaxGaussians budget;
  for (int s = 1; s < map.scales(); ++s) budget.by_scale[s] = map.gaussianCount(s);
  return budget;
}

void expectEqualScales(const GaussianMapOctree& a, const GaussianMapOctree& b) {
  for (int s = 0; s < a.scales(); ++s) {
    ASSERT_EQ(a.gaussianCount(s), b.gaussianCount(s));
    EXPECT_EQ(a.scale(s).parent, b.scale(s).parent);
    for (std::size_t i = 0; i < a.gaussianCount(s); ++i)
      EXPECT_EQ(a.localGaussian(i, s).mean, b.localGaussian(i, s).mean);
  }
}

TEST(ErrorCurve, ComesWithTheMapThatRefineMakes) {
  const GaussianMapOctree map = cloudMap(51);
  expectEqualScales(refine(map, PerCell{}, withCurves(quick())).map, refine<3>(map).map);
  EXPECT_TRUE(refine<3>(map).curves.empty());
}

TEST(ErrorCurve, StartsAtOnePerCellRisesInGaussiansAndFallsInError) {
  const GaussianMapOctree map = cloudMap(52);
  const RefineResult<3> refined = refine(map, PerCell{}, withCurves(quick()));
  ASSERT_EQ(refined.curves.size(), 2u);
  for (std::size_t c = 0; c < 2; ++c) {
    const ErrorCurve& curve = refined.curves[c];
    const int scale = static_cast<int>(c) + 1;
    EXPECT_EQ(curve.scale, scale);
    EXPECT_EQ(curve.points.front().gaussians, map.cellCount(scale));
    for (std::size_t i = 1; i < curve.points.size(); ++i)
      EXPECT_GT(curve.points[i].gaussians, curve.points[i - 1].gaussians);
    EXPECT_LT(curve.points.back().mean, 0.7 * curve.points.front().mean);
  }
}

TEST(ErrorCurve, MeasuresSamplesAmongTheMembersOfEachGaussian) {
  Random random(59);
  const GaussianMapOctree map = build<3>(roomPoints(random, 20000), {0.1, 5, 3, 0.0});
  CurveOptions curve;
  curve.multiples = {3.0};
  const RefineResult<3> refined = refine(map, PerCell{}, withCurves(curve));  // to three times the cells too
  SampleOptions data{curve.sampling.data, 1, SampleShare::Mass, curve.sampling.seed};
  const std::vector<Vector<3>> finest = sampleMap(map, 0, data).points;
  for (int s = 1; s < 3; ++s) {
    const ErrorPoint& point = refined.curves[static_cast<std::size_t>(s) - 1].points.front();
    ASSERT_EQ(point.gaussians, refined.map.gaussianCount(s));
    SampleOptions samples{curve.sampling.samples, 1, SampleShare::Volume, 7};  // other samples of the same
    const auto error = [&] { return summarise(nearestDistances(sampleMap(refined.map, s, samples).points, finest)); };
    EXPECT_NEAR(point.mean, error().mean, 0.02 * point.mean) << "scale " << s;
    EXPECT_NEAR(point.q95, error().q95, 0.03 * point.q95) << "scale " << s;
    samples.bounds = SampleBounds::Cell;
    if (s == 2) {
      EXPECT_GT(error().q95, 1.04 * point.q95);
    }
  }
}

TEST(ErrorCurve, IsTheSameAtOneAndTwoThreads) {
  const GaussianMapOctree map = cloudMap(53);
  RefineOptions one = withCurves(quick()), two = one;
  one.threads = 1;
  two.threads = 2;
  const RefineResult<3> a = refine(map, PerCell{}, one), b = refine(map, PerCell{}, two);
  expectEqualScales(a.map, b.map);
  for (std::size_t c = 0; c < a.curves.size(); ++c)
    for (std::size_t i = 0; i < a.curves[c].points.size(); ++i) {
      EXPECT_EQ(a.curves[c].points[i].q95, b.curves[c].points[i].q95);
      EXPECT_EQ(a.curves[c].points[i].mean, b.curves[c].points[i].mean);
    }
}

TEST(MaxGaussians, AreNeverExceededAndCanDifferByScale) {
  Random random(54);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const GaussianMapOctree map = cloudMap(60 + seed);
    MaxGaussians budget;
    for (int s = 1; s < 3; ++s) budget.by_scale[s] = map.cellCount(s) + random.below(2 * map.cellCount(s));
    for (const RefineMethod method : {RefineMethod::Agglomerate, RefineMethod::Insert}) {
      RefineOptions options;
      options.method = method;
      const GaussianMapOctree refined = refine<3>(map, budget, options).map;
      for (int s = 1; s < 3; ++s) {
        EXPECT_LE(refined.gaussianCount(s), budget.by_scale[s]);
        EXPECT_NEAR(refined.weight(s), 4000.0, 1e-6);
      }
    }
  }
}

TEST(MaxGaussians, BelowTheNumberOfCellsAreRefused) {
  const GaussianMapOctree map = cloudMap(55);
  EXPECT_THROW(refine<3>(map, MaxGaussians{{{1, map.cellCount(1) - 1}}}), std::invalid_argument);
  EXPECT_THROW(refine<3>(map, MaxGaussians{{{0, 100000}}}), std::invalid_argument);
  EXPECT_THROW(refine<3>(map, MaxGaussians{{{3, 100000}}}), std::invalid_argument);
}

TEST(MaxGaussians, OfOneScaleLeaveTheUsualBudgetToTheOthers) {
  const GaussianMapOctree map = cloudMap(55);
  const GaussianMapOctree refined = refine<3>(map, MaxGaussians{{{2, map.cellCount(2)}}}).map;
  EXPECT_EQ(refined.gaussianCount(1), refine<3>(map).map.gaussianCount(1));
  EXPECT_EQ(refined.gaussianCount(2), map.cellCount(2));
}

TEST(MaxError, IsReachedOrSaidNotToBe) {
  for (const double most : {0.02, 0.1, 0.2, 0.5, 5.0}) {
    const RefineResult<3> result = refine(cloudMap(56), MaxError{most, quickSampling()});
    EXPECT_TRUE(result.curves.empty());
    for (int s = 1; s < 3; ++s) {
      const NotReached* missed = nullptr;
      for (const NotReached& scale : result.not_reached)
        if (scale.scale == s) missed = &scale;
      const GaussianMapOctree& map = result.map;
      if (missed != nullptr) {
        EXPECT_GT(missed->q95, most);
        EXPECT_EQ(map.gaussianCount(s), map.gaussianCount(s - 1));
        continue;
      }
      // The curve of a map that is refined to these very numbers says what the error is.
      CurveOptions at = quick();
      at.multiples = {static_cast<double>(map.gaussianCount(s)) / static_cast<double>(map.cellCount(s)) * (1 + 1e-12)};
      const ErrorPoint point =
          refine(map, asManyAs(map), withCurves(at)).curves[static_cast<std::size_t>(s) - 1].points.front();
      ASSERT_EQ(point.gaussians, map.gaussianCount(s));
      EXPECT_LE(point.q95, most);
    }
  }
  EXPECT_THROW(refine(cloudMap(56), MaxError{}), std::invalid_argument);
}

TEST(MaxError, ComesWithCurvesIfAskedFor) {
  const GaussianMapOctree map = cloudMap(56);
  const MaxError budget{0.2, quickSampling()};
  const RefineResult<3> plain = refine(map, budget), measured = refine(map, budget, withCurves(quick()));
  expectEqualScales(measured.map, plain.map);
  EXPECT_EQ(measured.curves.size(), 2u);
}

TEST(MaxBytes, AreNeverExceededAndNearlyUsed) {
  const GaussianMapOctree map = cloudMap(57);
  const std::uintmax_t least = savedSize<3>(map);
  for (const bool curves : {false, true}) {
    const RefineOptions options = curves ? withCurves(quick()) : RefineOptions();
    for (const std::uintmax_t most : {least + 8000, least + 20000, least + 50000}) {
      const RefineResult<3> refined = refine(map, maxFileBytes(most), options);
      EXPECT_LE(savedSize(refined), most);
      EXPECT_GE(savedSize(refined) + 25000, most);
      EXPECT_EQ(refined.curves.size(), curves ? 2u : 0u);
    }
  }
  EXPECT_EQ(savedSize(refine(map, maxFileBytes(least))), least);
  EXPECT_THROW(refine(map, maxFileBytes(least / 2)), std::invalid_argument);
}

TEST(MaxBytes, ComeWithTheCurvesOfTheMapItself) {
  const GaussianMapOctree map = cloudMap(57);
  const RefineResult<3> refined = refine(map, maxFileBytes(savedSize<3>(map) + 50000), withCurves(quick()));
  const RefineResult<3> expected = refine(map, asManyAs(refined.map), withCurves(quick()));
  expectEqualScales(refined.map, expected.map);
  for (std::size_t c = 0; c < 2; ++c) {
    ASSERT_EQ(refined.curves[c].points.size(), expected.curves[c].points.size());
    for (std::size_t i = 0; i < expected.curves[c].points.size(); ++i)
      EXPECT_EQ(refined.curves[c].points[i].mean, expected.curves[c].points[i].mean);
  }
}

TEST(MaxBytes, AreKeptWhereOnlyTheCurvesExceedThem) {
  const GaussianMapOctree map = cloudMap(57);
  for (const std::size_t penalty : {std::size_t{10}, std::size_t{100}, std::size_t{1000000}}) {
    double trial_curve = 0.0;  // of the budgets tried out, whose curves are placeholders
    const auto bytesOf = [&](const RefineResult<3>& refined) -> std::uintmax_t {
      const double curve = refined.curves.back().points.back().mean;
      if (trial_curve == 0.0) trial_curve = curve;
      const bool costs_more = curve != trial_curve && refined.map.gaussianCount(1) > map.cellCount(1);
      return refined.map.gaussianCount(1) + refined.map.gaussianCount(2) + (costs_more ? penalty : 0);
    };
    const std::uintmax_t most = 3 * (map.cellCount(1) + map.cellCount(2));
    const RefineResult<3> refined = refine(map, MaxBytes{most, bytesOf}, withCurves(quick()));
    EXPECT_LE(bytesOf(refined), most) << penalty;
    EXPECT_EQ(refined.map.gaussianCount(1) == map.cellCount(1), penalty == 1000000) << penalty;
  }
}

TEST(SavedSize, IsTheSizeOfTheFile) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path path = folder.path() / "map.gmap";
  const GaussianMapOctree map = refine<3>(cloudMap(58)).map;
  save(path, map, {{"note", "x"}}, {true});
  EXPECT_EQ(std::filesystem::file_size(path), savedSize<3>(map, {{"note", "x"}}));
}

}  // namespace
}  // namespace gaussmap
