// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/sensor/evidence.h"

#include <gtest/gtest.h>

namespace gaussmap {
namespace {

TEST(Evidences, KnowTheFirstAndTheLastHitInAnyOrder) {
  Evidence evidence;
  evidence.miss();
  for (const std::uint32_t scan : {7u, 3u, 12u, 5u}) evidence.hit(scan);
  evidence.miss();
  EXPECT_EQ(evidence.hits, 4u);
  EXPECT_EQ(evidence.misses, 2u);
  EXPECT_EQ(evidence.first_hit, 3u);
  EXPECT_EQ(evidence.last_hit, 12u);
}

TEST(Evidences, AddUpToLogOdds) {
  EXPECT_EQ(logOdds(Evidence{}), 0.0);
  EXPECT_DOUBLE_EQ(logOdds(Evidence{4, 2, 3, 12}), 4 * 0.85 - 2 * 0.4);
  EXPECT_DOUBLE_EQ(logOdds(Evidence{1, 3, 0, 0}, OccupancyOptions{2.0, 0.5, 10.0}), 0.5);
  EXPECT_LT(logOdds(Evidence{0, 4000000000u, 0, 0}), -1e9);  // no bounds
}

TEST(Evidences, KeepWhatIsHitInThirtyTwoOfAHundredViews) {
  EXPECT_GT(logOdds(Evidence{33, 67, 0, 0}), 0.0);
  EXPECT_LT(logOdds(Evidence{31, 69, 0, 0}), 0.0);
}

}  // namespace
}  // namespace gaussmap
