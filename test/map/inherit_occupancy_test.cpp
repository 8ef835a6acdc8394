// SPDX-License-Identifier: BSD-3-Clause
// What a map knows of the occupancy of its Gaussians.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "gaussmap/editing/compress.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/files/temporary_directory.h"
#include "io/gmap/map_equality.h"
#include "map/inherit_occupancy.h"
#include "map/random_clouds.h"

namespace gaussmap::test {
using namespace detail;

namespace {

const MapOptions kOptions{0.05, 5, 3, 0.0};

/// From -3 to 10, no two neighbours alike.
float someLogOdds(std::size_t i) {
  return static_cast<float>(i * 37 % 53) * 0.25f - 3.0f;
}
GaussianMapOctree asked(const GaussianMapOctree& map) {
  std::vector<float> log_odds;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) log_odds.push_back(someLogOdds(i));
  return withOccupancy<3>(map, log_odds);
}

GaussianMapOctree randomMap(std::uint64_t seed) {
  return refine(build<3>(randomCloud<3>(3000, seed), kOptions)).map;
}

TEST(Occupancy, IsCertainUntilAScanIsAsked) {
  const GaussianMapOctree map = randomMap(1);
  EXPECT_FALSE(map.hasOccupancy());
  EXPECT_EQ(map.logOdds(0, 0), kMaxOccupancy);
  EXPECT_TRUE(asked(map).hasOccupancy());
  EXPECT_EQ(asked(map).logOdds(2, 0), someLogOdds(2));
}

TEST(Occupancy, IsKnownToAllScalesOrNone) {
  const GaussianMapOctree map = asked(randomMap(2));
  const auto changed = [&](auto&& change) {
    std::vector<MapScale<3>> scales = {map.scale(0), map.scale(1), map.scale(2)};
    change(scales);
    return GaussianMapOctree(map.options(), std::move(scales));
  };
  EXPECT_NO_THROW(changed([](auto&) {}));
  EXPECT_THROW(changed([](auto& scales) { scales[1].log_odds.clear(); }), std::invalid_argument);
  EXPECT_THROW(changed([](auto& scales) { scales[2].log_odds.clear(); }), std::invalid_argument);
  EXPECT_THROW(changed([](auto& scales) { scales[0].log_odds.pop_back(); }), std::invalid_argument);
  EXPECT_THROW(changed([](auto& scales) { scales[0].log_odds[0] = std::numeric_limits<float>::infinity(); }),
               std::invalid_argument);
}

TEST(Occupancy, SurvivesTheMapFileBitByBit) {
  const TemporaryDirectory directory;
  const GaussianMapOctree map = asked(randomMap(3));
  save(directory.path() / "map.gmap", map);
  expectSameMap<3>(load(directory.path() / "map.gmap"), map);
}

TEST(Occupancy, SurvivesThePcdFile) {
  const TemporaryDirectory directory;
  const GaussianMapOctree map = asked(randomMap(4)), plain = randomMap(4);
  savePcd(directory.path() / "map.pcd", map);
  savePcd(directory.path() / "plain.pcd", plain);
  const GaussianMapOctree got = loadPcd(directory.path() / "map.pcd");
  for (int s = 0; s < 3; ++s) EXPECT_EQ(got.scale(s).log_odds, map.scale(s).log_odds);
  EXPECT_FALSE(loadPcd(directory.path() / "plain.pcd").hasOccupancy());
}

TEST(Occupancy, OfACoarseGaussianIsTheHighestUnderIt) {
  for (const GaussianMapOctree& map : {asked(randomMap(5)), refine(asked(randomMap(5)), PerCell{2.0}).map})
    for (int s = 1; s < map.scales(); ++s)
      for (std::size_t i = 0; i < map.gaussianCount(s); ++i) {
        float highest = -std::numeric_limits<float>::infinity();
        for (const std::size_t child : map.childrenOf(i, s)) highest = std::max(highest, map.logOdds(child, s - 1));
        EXPECT_EQ(map.logOdds(i, s), highest);
      }
}

TEST(Occupancy, WhereNothingIsUnderAGaussianStays) {
  const GaussianMapOctree small = compress(asked(randomMap(7)), 0.04);
  ASSERT_TRUE(small.isCompressed());
  expectSameMap<3>(withOccupancy<3>(small, small.scale(0).log_odds), small);
}

TEST(Occupancy, IsGivenToEveryGaussianOrRefused) {
  const GaussianMapOctree map = randomMap(8);
  std::vector<float> log_odds(map.gaussianCount(0) - 1, 1.0f);
  EXPECT_THROW(withOccupancy<3>(map, log_odds), std::invalid_argument);
  log_odds.push_back(std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(withOccupancy<3>(map, log_odds), std::invalid_argument);
}

TEST(Occupancy, StaysWithWhatCompressionLeaves) {
  const GaussianMapOctree map = asked(randomMap(6));
  const GaussianMapOctree small = compress(map, 0.04);
  ASSERT_TRUE(small.isCompressed());
  EXPECT_EQ(small.scale(2).log_odds, map.scale(2).log_odds);
  ASSERT_GT(small.cellCount(0), 0u);
  ASSERT_LT(small.cellCount(0), map.cellCount(0));
  for (std::size_t cell = 0; cell < small.cellCount(0); ++cell)
    EXPECT_EQ(small.logOdds(cell, 0), map.logOdds(*map.find(small.scale(0).keys[cell], 0), 0));
}

}  // namespace
}  // namespace gaussmap::test
