// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/diff_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "mapping/map_checks.h"
#include "mapping/room.h"

namespace gaussmap::test {
namespace {

MapOptions grid() {
  return smallGrid<3>();
}

/// A box of points.
void addBox(std::vector<Vector<3>>& points, Random& random, const Vector<3>& low, const Vector<3>& size, int count) {
  for (int i = 0; i < count; ++i)
    points.emplace_back(low.x() + size.x() * random.uniform(), low.y() + size.y() * random.uniform(),
                        low.z() + size.z() * random.uniform());
}

TEST(DiffMaps, FindsNothingInTheSameMap) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(5000, 1), grid());
  for (int s = 0; s < 3; ++s) {
    DiffOptions options;
    options.scale = s;
    const MapDiff diff = diffMaps<3>(map, map, options);
    EXPECT_EQ(diff.count(Change::None), map.gaussianCount(s));
    EXPECT_EQ(diff.count(Change::New) + diff.count(Change::Gone) + diff.count(Change::Changed), 0u);
  }
  const GaussianMap<3> empty(grid());
  EXPECT_TRUE(diffMaps<3>(empty, empty).second.empty());
}

TEST(DiffMaps, CallsNoMoreThanTheLevelDifferentInAnotherSampleOfTheSameRoom) {
  Random random(2);
  const GaussianMap<3> first = build<3>(roomPoints(random, 200000), grid()),
                       second = build<3>(roomPoints(random, 100000), grid());
  for (int s = 0; s < 3; ++s) {
    for (const double level : {0.05, 0.01, 0.001}) {
      DiffOptions options;
      options.scale = s;
      options.level = level;
      options.points = 1e9;  // every point is drawn for itself here
      const MapDiff diff = diffMaps<3>(first, second, options);
      const auto differ = double(diff.count(Change::New) + diff.count(Change::Gone) + diff.count(Change::Changed));
      EXPECT_LE(differ, 2.0 + 1.5 * level * double(first.cellCount(s) + second.cellCount(s))) << s << " " << level;
    }
  }
}

TEST(DiffMaps, FindsABoxThatCameAndOneThatWent) {
  Random random(3);
  std::vector<Vector<3>> before = roomPoints(random, 100000), after = roomPoints(random, 100000);
  const Vector<3> size(0.5, 0.5, 0.5), gone(-1.5, -1.5, 0.0), fresh(-1.5, 1.0, 0.0);
  addBox(before, random, gone, size, 5000);
  addBox(after, random, fresh, size, 5000);
  const GaussianMap<3> first = build<3>(before, grid()), second = build<3>(after, grid());
  const MapDiff diff = diffMaps<3>(first, second);
  const auto isInside = [&](const Vector<3>& p, const Vector<3>& low) {
    return ((p - low).array() > 0.0).all() && ((p - low).array() < 0.5).all();
  };
  std::size_t found_gone = 0, found_new = 0;
  for (std::size_t i = 0; i < diff.first.size(); ++i)
    if (diff.first[i].change == Change::Gone) found_gone += isInside(first.gaussian(i, 0).mean, gone) ? 1 : 0;
  for (std::size_t i = 0; i < diff.second.size(); ++i)
    if (diff.second[i].change == Change::New) found_new += isInside(second.gaussian(i, 0).mean, fresh) ? 1 : 0;
  EXPECT_EQ(found_gone, 125u);  // 5 x 5 x 5 cells of 40 points
  EXPECT_EQ(found_new, 125u);
  EXPECT_LE(diff.count(Change::Gone), 125u + first.cellCount(0) / 100);  // the level
  EXPECT_LE(diff.count(Change::New), 125u + second.cellCount(0) / 100);
  const MapDiff back = diffMaps<3>(second, first);
  EXPECT_EQ(back.count(Change::New), diff.count(Change::Gone));
  EXPECT_EQ(back.count(Change::Gone), diff.count(Change::New));
  EXPECT_EQ(back.count(Change::Changed), diff.count(Change::Changed));
}

TEST(DiffMaps, FindsAWallThatMovedWithinItsCells) {
  Random random(4);
  std::vector<Vector<3>> before, after;
  addBox(before, random, {0, 0, 0.02}, {3, 3, 0.002}, 90000);
  addBox(after, random, {0, 0, 0.07}, {3, 3, 0.002}, 90000);
  const MapDiff diff = diffMaps<3>(build<3>(before, grid()), build<3>(after, grid()));
  EXPECT_EQ(diff.count(Change::Changed), 900u);
  for (const Difference& one : diff.first) EXPECT_EQ(one.change, Change::Changed);
}

TEST(DiffMaps, TellsNothingFromFewPoints) {
  // As many points in the shared cell: each falls into either map with probability 1/2. 0.5^6 > 0.01 > 0.5^7.
  std::vector<Vector<3>> before(20, {0.05, 0.05, 0.05}), after = before;
  before.insert(before.end(), 6, {5.05, 0.05, 0.05});
  after.insert(after.end(), 7, {-5.05, 0.05, 0.05});
  const MapDiff diff = diffMaps<3>(build<3>(before, grid()), build<3>(after, grid()));
  EXPECT_EQ(diff.count(Change::Gone), 0u);
  EXPECT_EQ(diff.count(Change::New), 1u);
  double least = 1.0;
  for (const Difference& one : diff.first) least = std::min(least, one.p_value);
  EXPECT_NEAR(least, std::pow(0.5, 6), 1e-12);
}

TEST(DiffMaps, WeighsHowManyPointsEachMapHas) {
  // Three of four points fall into the first map: 0.75^20 < 0.01 < 0.75^15.
  std::vector<Vector<3>> before(300, {0.05, 0.05, 0.05});
  const std::vector<Vector<3>> after(100, {0.05, 0.05, 0.05});
  before.insert(before.end(), 20, {5.05, 0.05, 0.05});
  before.insert(before.end(), 15, {-5.05, 0.05, 0.05});
  EXPECT_EQ(diffMaps<3>(build<3>(before, grid()), build<3>(after, grid())).count(Change::Gone), 1u);
}

TEST(DiffMaps, HasThePValueOfWaldsTest) {
  // 1000 equal points each, 10 of them independent: S = (1000 * 1e-4 + 0.01 / 12) / 1001 on each axis. In the plane
  // P(chi^2 >= x) = e^(-x / 2).
  MapOptions options = smallGrid<2>();
  options.noise = 0.01;
  const GaussianMap<2> first = build<2>(std::vector<Vector<2>>(1000, {0.045, 0.05}), options),
                       second = build<2>(std::vector<Vector<2>>(1000, {0.055, 0.05}), options);
  const double variance = (1000 * 1e-4 + 0.01 / 12.0) / 1001.0 / 10.0 * 2.0;
  const double d = (second.gaussian(0, 0).mean - first.gaussian(0, 0).mean).norm();
  EXPECT_NEAR(diffMaps<2>(first, second).second[0].p_value, std::exp(-0.5 * d * d / variance), 1e-9);
  // In space P(chi^2_3 >= 7.8147) = 0.05.
  const double step = std::sqrt(7.8147279) * std::sqrt(variance);
  const GaussianMap<3> a = build<3>(std::vector<Vector<3>>(1000, {0.05, 0.03, 0.05}), {0.1, 4, 3, 0.01}),
                       b = build<3>(std::vector<Vector<3>>(1000, {0.05, 0.03 + step, 0.05}), {0.1, 4, 3, 0.01});
  EXPECT_NEAR(diffMaps<3>(a, b).second[0].p_value, 0.05, 1e-4);
}

TEST(DiffMaps, LooksIntoTheCellsAround) {
  // The same wall, 2 mm apart, on either side of the border between cells.
  Random random(4);
  std::vector<Vector<3>> before, after;
  addBox(before, random, {0, 0, 0.098}, {3, 3, 0.001}, 90000);
  addBox(after, random, {0, 0, 0.101}, {3, 3, 0.001}, 90000);
  const MapDiff diff = diffMaps<3>(build<3>(before, grid()), build<3>(after, grid()));
  EXPECT_EQ(diff.count(Change::None), diff.second.size());
}

TEST(DiffMaps, RefusesWhatCannotBeCompared) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(500, 1), grid());
  MapOptions other = grid();
  other.resolution = 0.2;
  EXPECT_THROW(diffMaps<3>(map, GaussianMap<3>(other)), std::invalid_argument);
  for (const double level : {0.0, 1.0, std::nan("")}) {
    DiffOptions options;
    options.level = level;
    EXPECT_THROW(diffMaps<3>(map, map, options), std::invalid_argument);
  }
  DiffOptions options;
  options.scale = 3;
  EXPECT_THROW(diffMaps<3>(map, map, options), std::invalid_argument);
  options = {};
  options.points = 0.5;
  EXPECT_THROW(diffMaps<3>(map, map, options), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap::test
