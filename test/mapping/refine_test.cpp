// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "mapping/refine_helpers.h"

namespace gaussmap {
namespace {

TEST(CellError, IsTheMeanSquaredDistanceInStandardDeviationsOfTheData) {
  // Data at 0 and 3 with sigma 1 and 0.5, reference at 1: (1 + (2 / 0.5)^2) / 2; a second one at 3 takes the far datum.
  const auto at = [](double x, double sigma) {
    return Gaussian<3>{{x, 0, 0}, sigma * sigma * Eigen::Matrix3d::Identity(), 1.0};
  };
  const std::vector<Gaussian<3>> data = {at(0, 1), at(3, 0.5)};
  EXPECT_NEAR(cellError<3>({at(1, 7)}, data), 8.5, 1e-12);
  EXPECT_NEAR(cellError<3>({at(1, 7), at(3, 7)}, data), 0.5, 1e-12);
  EXPECT_EQ(cellError<3>({at(1, 7)}, {}), 0.0);
  EXPECT_THROW(cellError<3>({}, data), std::invalid_argument);
  EXPECT_THROW(cellError<3>({at(1, 7)}, {at(0, 0)}), std::domain_error);
}

TEST(CellError, UsesTheWholeCovariance) {  // correlated data: (1, -1) is farther than (1, 1)
  const Gaussian<2> z{{0, 0}, (Eigen::Matrix2d() << 1.0, 0.5, 0.5, 1.0).finished(), 1.0};
  EXPECT_NEAR(cellError<2>({{{1, 1}, Eigen::Matrix2d::Identity(), 1.0}}, {z}), 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(cellError<2>({{{1, -1}, Eigen::Matrix2d::Identity(), 1.0}}, {z}), 4.0, 1e-12);
}

TEST(Refine, NamesTheOptionThatItRefuses) {
  const GaussianMap<3> map = roomMap(100);
  const auto messageFor = [&](void (*spoil)(RefineOptions&), const Budget& budget = PerCell{}) -> std::string {
    RefineOptions options;
    spoil(options);
    try {
      refine(map, budget, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const double budget : {0.99, std::nan(""), HUGE_VAL})
    EXPECT_EQ(messageFor([](RefineOptions&) {}, PerCell{budget}).find("budget"), 0u);
  EXPECT_EQ(messageFor([](RefineOptions&) {}, MaxBytes{1000, {}}).find("max_bytes"), 0u);
  EXPECT_EQ(messageFor([](RefineOptions&) {}, MaxError{-1.0, {}}).find("max_error"), 0u);
  EXPECT_EQ(messageFor([](RefineOptions& o) { o.curves = CurveOptions{{0.5}, {}}; }).find("multiples"), 0u);
  const auto inserted = [](RefineOptions& o) { o.method = RefineMethod::Insert; };
  EXPECT_EQ(messageFor(inserted, MaxError{1.0, {}}).find("method"), 0u);
  EXPECT_EQ(messageFor([](RefineOptions& o) { o.queue = -1; }).find("queue"), 0u);
  EXPECT_EQ(messageFor([](RefineOptions& o) { o.max_swaps = -1; }).find("max_swaps"), 0u);
  EXPECT_EQ(messageFor([](RefineOptions& o) { o.threads = -1; }).find("threads"), 0u);
}

/// What every method promises.
class RefineBy : public testing::TestWithParam<RefineMethod> {};

std::string nameOf(const testing::TestParamInfo<RefineMethod>& method) {
  return method.param == RefineMethod::Insert ? "Insertion" : "Agglomeration";
}
INSTANTIATE_TEST_SUITE_P(All, RefineBy, testing::ValuesIn(kMethods), nameOf);

TEST_P(RefineBy, LeavesAnEmptyMapAndASingleScaleAlone) {
  EXPECT_TRUE(refine(GaussianMap<3>(), PerCell{3.0}, by(GetParam())).map.empty());
  const GaussianMap<3> single = roomMap(1000, 5, 1);
  expectSameBytes(refine(single, PerCell{3.0}, by(GetParam())).map, single);
}

TEST_P(RefineBy, WithABudgetOfOneIsCoarsening) {
  const GaussianMap<3> map = roomMap();
  expectSameBytes(refine(map, PerCell{1.0}, by(GetParam())).map, map);
  expectSameBytes(refine(refine(map, PerCell{4.0}, by(GetParam())).map, PerCell{1.0}, by(GetParam())).map,
                  map);  // older clusters are forgotten
}

TEST_P(RefineBy, KeepsToItsBudgetAndUsesIt) {
  const GaussianMap<3> map = roomMap();
  for (double budget : {1.0, 1.003, 1.5, 2.0, 3.7}) {
    const GaussianMap<3> refined = refine(map, PerCell{budget}, by(GetParam())).map;
    EXPECT_EQ(refined.gaussianCount(0), map.gaussianCount(0));
    for (int s = 1; s < map.scales(); ++s) {
      EXPECT_EQ(refined.cellCount(s), map.cellCount(s));
      const auto most = static_cast<std::size_t>(std::floor(budget * static_cast<double>(map.cellCount(s))));
      EXPECT_EQ(refined.gaussianCount(s), std::min(most, refined.gaussianCount(s - 1)));
    }
  }
}

TEST_P(RefineBy, StopsAtAClusterForEveryFinerGaussian) {
  const GaussianMap<3> map = roomMap(3000, 3, 2);
  const GaussianMap<3> refined = refine(map, PerCell{1e300}, by(GetParam())).map;
  EXPECT_EQ(refined.gaussianCount(1), refined.gaussianCount(0));
  EXPECT_EQ(meanError(refined, 1), 0.0);
}

TEST_P(RefineBy, KeepsTheNumberOfPointsAtEveryScale) {
  const GaussianMap<3> refined = refine(roomMap(), PerCell{3.0}, by(GetParam())).map;
  for (int s = 0; s < refined.scales(); ++s) EXPECT_EQ(refined.weight(s), 60000.0);
}

TEST_P(RefineBy, MakesEveryClusterTheMomentMatchOfItsChildren) {
  const GaussianMap<3> refined = refine(roomMap(), PerCell{3.0}, by(GetParam())).map;
  for (int s = 1; s < refined.scales(); ++s) {
    for (std::size_t cell = 0; cell < refined.cellCount(s); ++cell) {
      const std::vector<Gaussian<3>> data = dataUnder(refined, cell, s);
      const std::size_t first = refined.gaussiansUnder(cell, s).first;
      const IndexRange clusters = refined.gaussiansOf(cell, s);
      for (std::size_t cluster = clusters.first; cluster < clusters.last; ++cluster) {
        std::vector<Gaussian<3>> members;
        for (std::size_t child : refined.childrenOf(cluster, s)) members.push_back(data[child - first]);
        ASSERT_FALSE(members.empty());
        const Gaussian<3> match = merge(members), found = refined.localGaussian(cluster, s);
        ASSERT_EQ(found.mean, match.mean);
        ASSERT_EQ(found.cov, match.cov);
        ASSERT_EQ(found.weight, match.weight);
      }
    }
  }
}

TEST_P(RefineBy, PutsThePoleOfACellIntoAClusterOfItsOwn) {
  // One coarse cell of 4 m: a floor of 60 x 60 points and a pole of 1 m; two Gaussians for it.
  std::vector<Vector<3>> points;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) points.push_back({0.05 + 0.06 * i, 0.05 + 0.06 * j, 0.05});
  for (int i = 0; i < 300; ++i) points.push_back({2.05, 2.05, 1.0 + 0.01 * i});
  MapOptions map_options;
  map_options.ratio = 40;
  map_options.scales = 2;
  const GaussianMap<3> refined = refine(build(points, map_options), PerCell{2.0}, by(GetParam())).map;
  ASSERT_EQ(refined.gaussianCount(1), 2u);
  const Gaussian<3> a = refined.gaussian(0, 1), b = refined.gaussian(1, 1);
  const Gaussian<3>& floor = a.weight > b.weight ? a : b;
  const Gaussian<3>& pole = a.weight > b.weight ? b : a;
  EXPECT_EQ(floor.weight, 3600.0);
  EXPECT_NEAR(floor.cov(2, 2), 0.005 * 0.005, 1e-9);
  EXPECT_EQ(pole.weight, 300.0);
  EXPECT_NEAR(pole.cov(0, 0), 0.005 * 0.005, 1e-9);
}

TEST_P(RefineBy, DependsOnTheFinestScaleOnly) {
  const GaussianMap<3> map = roomMap(20000);
  const GaussianMap<3> refined = refine(map, PerCell{3.0}, by(GetParam())).map;
  expectSameBytes(refine(map, PerCell{3.0}, by(GetParam())).map, refined);
  expectSameBytes(refine(refined, PerCell{3.0}, by(GetParam())).map, refined);
}

TEST_P(RefineBy, GivesTheSameBytesAtAnyNumberOfThreads) {
  const GaussianMap<3> map = roomMap(60000, 4, 3);
  for (const MergeCost cost : {MergeCost::Volume, MergeCost::Runnalls}) {
    for (const int queue : {0, 1, 500}) {  // 500: rounds of insertions that are worth several threads
      RefineOptions options = by(GetParam());
      options.merge_cost = cost;
      options.queue = queue;
      options.threads = 1;
      const GaussianMap<3> alone = refine(map, PerCell{4.0}, options).map;
      for (int threads : {2, 3, 0}) {
        options.threads = threads;
        expectSameBytes(refine(map, PerCell{4.0}, options).map, alone);
      }
    }
  }
}

TEST_P(RefineBy, LowersTheErrorWithTheBudget) {
  const GaussianMap<3> map = roomMap();
  double before = std::numeric_limits<double>::infinity();
  for (double budget : {1.0, 1.5, 2.0, 3.0, 5.0}) {
    const double error = meanError(refine(map, PerCell{budget}, by(GetParam())).map, 1);
    EXPECT_LT(error, before);
    before = error;
  }
  EXPECT_LT(before, 0.25 * meanError(map, 1));
}

TEST_P(RefineBy, HandlesOneCellAndOnePoint) {
  MapOptions options;
  options.scales = 3;
  const GaussianMap<2> one = build(std::vector<Vector<2>>{{0.5, 0.5}}, options);
  expectSameBytes(refine(one, PerCell{3.0}, by(GetParam())).map, one);
  const GaussianMap<2> two =
      refine(build(std::vector<Vector<2>>{{0.05, 0.05}, {0.45, 0.45}}, options), PerCell{3.0}, by(GetParam())).map;
  EXPECT_EQ(two.gaussianCount(1), 2u);  // budget 3, but there are only two
  EXPECT_EQ(two.gaussianCount(2), 2u);
  EXPECT_EQ(two.parentOf(1, 0), 1u);
  EXPECT_EQ(two.parentOf(1, 1), 1u);
}

TEST_P(RefineBy, WorksInThePlane) {
  Random random(9);
  std::vector<Vector<2>> points;
  for (int i = 0; i < 5000; ++i) {
    const double t = 8.0 * random.uniform() - 4.0;
    points.push_back({i % 2 ? t : 0.003 * random.normal(), i % 2 ? 0.003 * random.normal() : t});
  }
  MapOptions options;
  options.resolution = 0.05;
  const GaussianMap<2> refined = refine(build(points, options), PerCell{3.0}, by(GetParam())).map;
  EXPECT_EQ(refined.gaussianCount(1), 3 * refined.cellCount(1));
  EXPECT_EQ(refined.weight(2), 5000.0);
}

}  // namespace
}  // namespace gaussmap
