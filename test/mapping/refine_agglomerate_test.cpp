// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "clustering/merge_gains.h"
#include "gaussmap/clustering/agglomerate.h"
#include "mapping/refine_helpers.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Occupied finest cells under every Gaussian of scale s, counted one by one through the links.
std::vector<double> areasOf(const GaussianMap<3>& map, int s) {
  std::vector<double> areas(map.gaussianCount(s), 0.0);
  for (std::size_t finest = 0; finest < map.gaussianCount(0); ++finest) {
    std::size_t index = finest;
    for (int level = 0; level < s; ++level) index = map.parentOf(index, level);
    areas[index] += 1.0;
  }
  return areas;
}

/// The dendrogram of a cell by the definition.
Dendrogram dendrogramUnder(const GaussianMap<3>& map, std::size_t cell, int s, MergeCost cost) {
  std::vector<Gaussian<3>> data = dataUnder(map, cell, s);
  const double tau = 0.5 * map.grid().side(0);
  for (Gaussian<3>& gaussian : data) gaussian.cov.diagonal().array() += tau * tau;
  const std::vector<double> all = areasOf(map, s - 1);
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(map.gaussiansUnder(cell, s).first);
  AgglomerateOptions options;
  options.cost = cost;
  return agglomerate(data, {first, first + static_cast<std::ptrdiff_t>(data.size())}, options);
}

TEST(RefineByAgglomeration, CutsTheDendrogramsWhereItGainsMost) {
  for (const MergeCost cost : {MergeCost::Volume, MergeCost::Runnalls}) {
    RefineOptions options;
    options.merge_cost = cost;
    const GaussianMap<3> refined = refine(roomMap(20000, 3, 4), PerCell{2.3}, options).map;
    for (int s = 1; s < refined.scales(); ++s) {
      std::vector<Dendrogram> dendrograms;
      std::vector<std::vector<double>> gains;
      for (std::size_t cell = 0; cell < refined.cellCount(s); ++cell) {
        dendrograms.push_back(dendrogramUnder(refined, cell, s, cost));
        gains.push_back(mergeGains(dendrograms.back()));
      }
      const std::vector<std::size_t> parts = partsPerCell(gains, refined.gaussianCount(s) - refined.cellCount(s));
      for (std::size_t cell = 0; cell < refined.cellCount(s); ++cell) {
        const std::size_t first = refined.gaussiansOf(cell, s).first, under = refined.gaussiansUnder(cell, s).first;
        ASSERT_EQ(refined.gaussiansOf(cell, s).size(), parts[cell]);
        const std::vector<int> expected = labels(dendrograms[cell], parts[cell]);
        for (std::size_t j = 0; j < expected.size(); ++j)
          ASSERT_EQ(refined.parentOf(under + j, s - 1), first + static_cast<std::size_t>(expected[j]));
      }
    }
  }
}

TEST(RefineByAgglomeration, IgnoresSeedAndOptionsOfInsertion) {
  const GaussianMap<3> map = roomMap(20000);
  RefineOptions options;
  ASSERT_EQ(options.method, RefineMethod::Agglomerate);  // the default
  const GaussianMap<3> refined = refine(map).map;
  options.seed = 6;
  options.queue = 1;
  expectSameBytes(refine(map, PerCell{}, options).map, refined);
}

TEST(RefineByAgglomeration, DoesNotCareHowDenseThePointsAre) {
  // Every third finest cell seen a thousand times as often: the same parts at the scale above.
  const GaussianMap<3> map = roomMap(20000, 5, 2);
  MapScale<3> finest;
  finest.keys = map.scale(0).keys;
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) finest.gaussians.push_back(map.localGaussian(cell, 0));
  MapScale<3> dense = finest;
  for (std::size_t cell = 0; cell < dense.keys.size(); cell += 3) dense.gaussians[cell].weight *= 1000.0;
  const GaussianMap<3> refined = refine(build(finest, map.options())).map;
  EXPECT_EQ(refine(build(dense, map.options())).map.scale(0).parent, refined.scale(0).parent);
  EXPECT_EQ(refine(map).map.scale(0).parent, refined.scale(0).parent);
}

TEST(RefineByAgglomeration, SharesTheAreaOfACellAmongItsGaussians) {
  // Three in a row, two of them in one cell and a little closer to each other, the third in a cell of its own: with
  // areas 1/2, 1/2, 1 the second and the third make the smaller ellipsoid, with equal areas the first and the second.
  MapScale<2> finest;
  finest.keys = {{0, 0}, {1, 0}};
  finest.first_gaussian = {0, 2, 3};
  for (const double x : {-0.049, 0.045, 0.041})  // from the middles of the cells, 10 cm apart
    finest.gaussians.push_back({{x, 0}, 1e-4 * Eigen::Matrix2d::Identity(), 10.0});
  MapOptions options;
  options.scales = 2;
  MapScale<2> coarse = coarsen(finest, Grid<2>(options), 0);
  const GaussianMap<2> map(options, {finest, coarse});
  const GaussianMap<2> refined = refine(map, PerCell{2.0}, by(RefineMethod::Agglomerate)).map;
  ASSERT_EQ(refined.gaussianCount(1), 2u);
  EXPECT_EQ(refined.scale(0).parent, (std::vector<std::uint32_t>{0, 1, 1}));
}

TEST(RefineByAgglomeration, TakesGaussiansWithoutExtent) {
  MapScale<2> finest;
  finest.keys = {{0, 0}, {1, 0}, {8, 8}};
  finest.gaussians.assign(3, {{0, 0}, Eigen::Matrix2d::Zero(), 1.0});
  MapOptions options;
  options.scales = 2;
  const GaussianMap<2> refined = refine(build(finest, options), PerCell{2.0}, by(RefineMethod::Agglomerate)).map;
  EXPECT_EQ(refined.scale(0).parent, (std::vector<std::uint32_t>{0, 0, 1}));
}

TEST(RefineByAgglomeration, ClaimsLessVolumeThanInsertion) {
  const GaussianMap<3> map = roomMap();
  const auto volumeOf = [](const GaussianMap<3>& refined, int s) {
    double volume = 0.0;
    for (const Gaussian<3>& cluster : refined.scale(s).gaussians)
      volume += std::exp(0.5 * logDeterminant<3>(cluster.cov));
    return volume;
  };
  const GaussianMap<3> merged = refine(map, PerCell{3.0}, by(RefineMethod::Agglomerate)).map;
  const GaussianMap<3> inserted = refine(map, PerCell{3.0}, by(RefineMethod::Insert)).map;
  for (int s = 1; s < map.scales(); ++s) EXPECT_LT(volumeOf(merged, s), volumeOf(inserted, s));
}

}  // namespace
}  // namespace gaussmap
