// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/refine_helpers.h"

namespace gaussmap {
namespace {

TEST(RefineByInsertion, DependsOnTheSeed) {
  const GaussianMap<3> map = roomMap(20000);
  RefineOptions options = withBudget(3.0, RefineMethod::Insert);
  options.seed = 5;
  const GaussianMap<3> refined = refine(map, options);
  expectSameBytes(refine(map, options), refined);
  options.seed = 6;
  EXPECT_NE(refine(map, options).scale(0).parent, refined.scale(0).parent);
}

TEST(RefineByInsertion,
     SpendsWhereTheErrorIs) {  // one at a time: no cell that was left alone is worse than the worst refined one
  RefineOptions options = withBudget(1.5, RefineMethod::Insert);
  options.queue = 1;
  const GaussianMap<3> map = roomMap();
  const GaussianMap<3> refined = refine(map, options);
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

double volumeOf(const GaussianMap<3>& map, std::size_t cell, int s) {
  double volume = 0.0;
  for (const Gaussian<3>& cluster : clustersOf(map, cell, s)) volume += std::exp(0.5 * logDeterminant<3>(cluster.cov));
  return volume;
}

TEST(RefineByInsertion, SpendsWhereTheVolumeIsIfAskedTo) {
  RefineOptions options = withBudget(1.5, RefineMethod::Insert);
  options.queue = 1;
  options.cell_choice = CellChoice::Volume;
  const GaussianMap<3> map = roomMap();
  const GaussianMap<3> refined = refine(map, options);
  EXPECT_EQ(refined.gaussianCount(1), map.cellCount(1) * 3 / 2);
  double largest_alone = 0.0, least_refined = std::numeric_limits<double>::infinity();
  for (std::size_t cell = 0; cell < map.cellCount(1); ++cell) {
    const double volume = volumeOf(map, cell, 1);
    if (refined.gaussiansOf(cell, 1).size() > 1)
      least_refined = std::min(least_refined, volume);
    else if (dataUnder(map, cell, 1).size() > 1)
      largest_alone = std::max(largest_alone, volume);
  }
  EXPECT_GE(least_refined, largest_alone);
}

}  // namespace
}  // namespace gaussmap
