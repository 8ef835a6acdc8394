// SPDX-License-Identifier: BSD-3-Clause
#include "segments/segment_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {
namespace {

Strip randomStrip(Random& random, double reach) {
  const double angle = 6.3 * random.uniform();
  return {Vector<2>(reach * (random.uniform() - 0.5), reach * (random.uniform() - 0.5)),
          {std::cos(angle), std::sin(angle)},
          4.0 * random.uniform() * random.uniform(),
          0.3 * random.uniform()};
}

TEST(SegmentIndex, FindsEveryStripThatABruteForceSearchFinds) {
  Random random(1);
  SegmentIndex index;
  std::vector<Strip> strips(60);
  std::vector<bool> entered(strips.size(), false);
  std::size_t found = 0;
  for (int step = 0; step < 3000; ++step) {
    const std::size_t id = random.below(strips.size());
    if (entered[id] && random.uniform() < 0.2) {
      index.erase(static_cast<int>(id));
      entered[id] = false;
    } else {
      // Often only a little moved, so that the entry may stay.
      if (entered[id] && random.uniform() < 0.7)
        strips[id].start += 0.05 * Vector<2>(random.normal(), random.normal());
      else
        strips[id] = randomStrip(random, 10.0);
      index.update(static_cast<int>(id), strips[id]);
      entered[id] = true;
    }
    const Vector<2> point(12.0 * (random.uniform() - 0.5), 12.0 * (random.uniform() - 0.5));
    const std::vector<int>& near = index.near(point);
    EXPECT_EQ(std::set<int>(near.begin(), near.end()).size(), near.size());
    for (std::size_t k = 0; k < strips.size(); ++k) {
      const bool listed = std::find(near.begin(), near.end(), static_cast<int>(k)) != near.end();
      if (entered[k] && strips[k].contains(point)) {
        EXPECT_TRUE(listed);
        ++found;
      }
      if (!entered[k]) {
        EXPECT_FALSE(listed);
      }
    }
  }
  EXPECT_GT(found, 200u);
}

TEST(SegmentIndex, WorksFarFromTheOrigin) {
  SegmentIndex index;
  index.update(0, {{1e7, -1e7}, {1.0, 0.0}, 2.0, 0.1});
  EXPECT_EQ(index.near({1e7 + 1.0, -1e7}), std::vector<int>{0});
  EXPECT_TRUE(index.near({1e7 + 5.0, -1e7}).empty());
}

TEST(Strip, ContainsWhatIsBetweenItsEndsAndNearItsMiddleLine) {
  const Strip strip{{1.0, 1.0}, {0.0, 1.0}, 2.0, 0.1};
  EXPECT_TRUE(strip.contains({1.05, 2.9}));
  EXPECT_FALSE(strip.contains({1.15, 2.0}));
  EXPECT_FALSE(strip.contains({1.0, 3.1}));
  EXPECT_FALSE(strip.contains({1.0, 0.9}));
}

}  // namespace
}  // namespace gaussmap::detail
