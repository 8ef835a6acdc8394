// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/refine_helpers.h"

namespace gaussmap {
namespace {

TEST(RefineByInsertion, DependsOnTheSeed) {
  const GaussianMap<3> map = roomMap(20000);
  RefineOptions options = by(RefineMethod::Insert);
  options.seed = 5;
  const GaussianMap<3> refined = refine(map, PerCell{3.0}, options).map;
  expectSameBytes(refine(map, PerCell{3.0}, options).map, refined);
  options.seed = 6;
  EXPECT_NE(refine(map, PerCell{3.0}, options).map.scale(0).parent, refined.scale(0).parent);
}

TEST(RefineByInsertion,
     SpendsWhereTheErrorIs) {  // one at a time: no cell that was left alone is worse than the worst refined one
  RefineOptions options = by(RefineMethod::Insert);
  options.queue = 1;
  const GaussianMap<3> map = roomMap();
  const GaussianMap<3> refined = refine(map, PerCell{1.5}, options).map;
  double worst_alone = 0.0, least_refined = std::numeric_limits<double>::infinity();
  for (std::size_t cell = 0; cell < map.cellCount(1); ++cell) {
    const double error = errorOf(map, cell, 1);  // scale 0 is the same in both
    if (refined.gaussiansOf(cell, 1).size() == 1)
      worst_alone = std::max(worst_alone, error);
    else
      least_refined = std::min(least_refined, error);
  }
  EXPECT_GE(least_refined, worst_alone);
}

TEST(RefineByInsertion, OfThePaperTakesFourCellsAtATimeAndSeedsAtTheInput) {
  const RefineOptions paper = RefineOptions::yguel2009();
  RefineOptions options = by(RefineMethod::Insert);
  options.queue = 4;
  options.seed_rule = ClusterSeed::InputGaussian;
  const GaussianMap<3> map = roomMap(20000);
  const GaussianMap<3> refined = refine(map, PerCell{2.0}, paper).map;
  expectSameBytes(refine(map, PerCell{2.0}, options).map, refined);
  EXPECT_EQ(refined.gaussianCount(1), 2 * map.cellCount(1));
  EXPECT_NE(refine(map, PerCell{2.0}, by(RefineMethod::Insert)).map.scale(0).parent, refined.scale(0).parent);
}

/// Returns the mean of KL(finest Gaussian || its parent), weighted with the numbers of points.
double meanDivergence(const GaussianMap<3>& map) {
  double sum = 0.0;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i)
    sum += map.gaussian(i, 0).weight * klDivergence(map.gaussian(i, 0), map.gaussian(map.parentOf(i, 0), 1));
  return sum;
}

TEST(RefineByInsertion, TakesTheDistanceAndIsTheSameAtAnyNumberOfThreads) {
  const GaussianMap<3> map = roomMap(20000);
  const double one_per_cell = meanDivergence(map);
  std::vector<std::vector<std::uint32_t>> parents;
  for (const GaussianDistance distance : {GaussianDistance::KL, GaussianDistance::SymmetricKL,
                                          GaussianDistance::Bhattacharyya, GaussianDistance::Wasserstein}) {
    RefineOptions options = by(RefineMethod::Insert);
    options.distance = distance;
    options.threads = 1;
    const GaussianMap<3> refined = refine(map, PerCell{2.0}, options).map;
    EXPECT_LT(meanDivergence(refined), 0.9 * one_per_cell) << static_cast<int>(distance);
    EXPECT_GT(refined.gaussianCount(1), map.cellCount(1) * 19 / 10);
    options.threads = 3;
    expectSameBytes(refine(map, PerCell{2.0}, options).map, refined);
    for (const auto& others : parents) EXPECT_NE(refined.scale(0).parent, others);
    parents.push_back(refined.scale(0).parent);
  }
}

}  // namespace
}  // namespace gaussmap
