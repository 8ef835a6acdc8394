// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "map/inherit_occupancy.h"
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

/// The map with random log-odds between the limits.
GaussianMap<3> withRandomOccupancy(const GaussianMap<3>& map) {
  Random random(9);
  std::vector<float> log_odds(map.gaussianCount(0));
  for (float& one : log_odds) one = static_cast<float>(20.0 * random.uniform() - 10.0);
  return withOccupancy<3>(map, log_odds);
}

double meanProbability(const GaussianMap<3>& map, std::size_t cell, int s) {
  const IndexRange under = map.gaussiansUnder(cell, s);
  double sum = 0.0;
  for (std::size_t i = under.first; i < under.last; ++i) sum += 1.0 / (1.0 + std::exp(-map.logOdds(i, s - 1)));
  return sum / static_cast<double>(under.size());
}

/// Returns the number of cells of scale 1 that are probably free but have several Gaussians.
std::size_t refinedFreeCells(const GaussianMap<3>& map) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < map.cellCount(1); ++cell)
    count += map.gaussiansOf(cell, 1).size() > 1 && meanProbability(map, cell, 1) <= 0.5;
  return count;
}

TEST(RefineByInsertion, OfThePaperLeavesFreeCellsAlone) {
  const GaussianMap<3> map = withRandomOccupancy(roomMap(20000));
  RefineOptions options = RefineOptions::yguel2009();
  const GaussianMap<3> refined = refine(map, PerCell{1.5}, options).map;
  EXPECT_EQ(refinedFreeCells(refined), 0u);
  EXPECT_EQ(refined.gaussianCount(1), map.cellCount(1) * 3 / 2);  // the occupied cells get the whole budget
  options.only_occupied = false;
  EXPECT_GT(refinedFreeCells(refine(map, PerCell{1.5}, options).map), 5u);
}

TEST(RefineByInsertion, OfThePaperAddsToNoCellOfAFreeMap) {
  const GaussianMap<3> room = roomMap(20000);
  const GaussianMap<3> free = withOccupancy<3>(room, std::vector<float>(room.gaussianCount(0), -0.1f));
  const GaussianMap<3> refined = refine(free, PerCell{3.0}, RefineOptions::yguel2009()).map;
  for (int s = 1; s < 3; ++s) EXPECT_EQ(refined.gaussianCount(s), free.cellCount(s));
}

/// Eq. (6) of a cell of scale 1 with one Gaussian, term by term, with eps of eq. (5).
double weighedError(const GaussianMap<3>& map, std::size_t cell) {
  const Gaussian<3> w = merge(dataUnder(map, cell, 1));
  const IndexRange under = map.gaussiansUnder(cell, 1);
  const std::vector<Gaussian<3>> data = dataUnder(map, cell, 1);
  double sum = 0.0;
  for (std::size_t j = 0; j < data.size(); ++j) {
    const Vector<3> apart = w.mean - data[j].mean;
    const double eps = (5e-4 - 5e-2) / 20.0 * (map.logOdds(under.first + j, 0) + 10.0) + 5e-2;
    sum += (1.0 - eps) * apart.dot(data[j].cov.inverse() * apart);
  }
  return sum / static_cast<double>(data.size());
}

TEST(RefineByInsertion, OfThePaperWeighsTheErrorByTheLearningRate) {
  const GaussianMap<3> map = withRandomOccupancy(roomMap());
  RefineOptions options = RefineOptions::yguel2009();
  options.queue = 1;
  options.only_occupied = false;
  // Returns true if the cells that were refined are those of largest weighed error.
  const auto isByWeighedError = [&] {
    const GaussianMap<3> refined = refine(map, PerCell{1.5}, options).map;
    double worst_alone = 0.0, least_refined = std::numeric_limits<double>::infinity();
    for (std::size_t cell = 0; cell < map.cellCount(1); ++cell) {
      if (map.gaussiansUnder(cell, 1).size() < 2) continue;
      const double error = weighedError(map, cell);
      if (refined.gaussiansOf(cell, 1).size() == 1)
        worst_alone = std::max(worst_alone, error);
      else
        least_refined = std::min(least_refined, error);
    }
    return least_refined >= worst_alone * (1.0 - 1e-9);
  };
  EXPECT_TRUE(isByWeighedError());
  options.learning_factor = false;
  EXPECT_FALSE(isByWeighedError());
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
