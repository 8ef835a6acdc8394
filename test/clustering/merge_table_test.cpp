// SPDX-License-Identifier: BSD-3-Clause
#include "clustering/merge_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "clustering/random_gaussians.h"

namespace gaussmap {
using namespace detail;

namespace {

template <int D>
void expectTheSameBits(MergeCost cost) {
  Random random(1);
  const std::size_t n = 67;  // no multiple of any number of lanes
  MergeTable<D> table(randomGaussians<D>(random, n), std::vector<double>(n, 3.0), cost);
  table.unite(5, 40);
  table.unite(5, 9);
  std::vector<double> row(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t first : {std::size_t{0}, std::size_t{1}, i}) {
      table.costs(i, first, n, row.data());
      for (std::size_t j = first; j < n; ++j) {
        ASSERT_FALSE(std::isnan(row[j - first]));
        ASSERT_EQ(row[j - first], table.cost(j, i));
        ASSERT_EQ(row[j - first], table.cost(i, j));
      }
    }
  }
  EXPECT_EQ(table.cost(40, 3), std::numeric_limits<double>::infinity());
  EXPECT_EQ(table.cost(3, 9), std::numeric_limits<double>::infinity());
}

TEST(MergeTable, GivesTheSameBitsInEveryLaneAndDirection) {
  for (const MergeCost cost : {MergeCost::Volume, MergeCost::Runnalls, MergeCost::KL}) {
    expectTheSameBits<2>(cost);
    expectTheSameBits<3>(cost);
  }
}

TEST(MergeTable, KeepsMoments) {  // after any merges the last cluster is the moment match of all
  Random random(2);
  std::vector<Gaussian<3>> data = randomGaussians<3>(random, 20);
  std::vector<double> areas;
  for (Gaussian<3>& gaussian : data) {
    areas.push_back(1.0 + static_cast<double>(random.below(9)));
    gaussian.weight = areas.back();
  }
  const Gaussian<3> all = merge(data), probe = {{4, 5, 6}, Matrix<3>::Identity(), 1.0};
  const double expected =
      std::exp(0.5 * logDeterminant<3>(merge<3>({all, probe}).cov)) - std::exp(0.5 * logDeterminant<3>(all.cov)) - 1.0;
  data.push_back(probe);
  areas.push_back(1.0);
  MergeTable<3> table(data, areas, MergeCost::Volume);
  for (std::size_t step = 1; step < 20; step *= 2)
    for (std::size_t a = 0; a + step < 20; a += 2 * step) table.unite(a, a + step);
  EXPECT_NEAR(table.cost(0, 20), expected, 1e-11 * std::abs(expected));
  table.keep({0, 20});
  EXPECT_EQ(table.slots(), 2u);
  EXPECT_NEAR(table.cost(0, 1), expected, 1e-11 * std::abs(expected));
}

TEST(FirstMinimum, IsTheFirstOfTheSmallestAtAnyLength) {
  Random random(3);
  for (std::size_t size = 1; size < 100; ++size) {
    std::vector<double> values(size);
    for (double& value : values) value = static_cast<double>(random.below(5)) - 2.0;
    if (size % 7 == 0) values.assign(size, std::numeric_limits<double>::infinity());
    EXPECT_EQ(firstMinimum(values.data(), size),
              static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin()));
  }
}

}  // namespace
}  // namespace gaussmap
