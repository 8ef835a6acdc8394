// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/removal_score.h"

#include <gtest/gtest.h>

namespace gaussmap {
using namespace detail;

namespace {

TEST(RemovalScoreTest, CountsWhatWasKeptAndWhatWasRemoved) {
  RemovalScore score;
  for (int i = 0; i < 100; ++i) score.add(false, i < 19);  // 81 of 100 kept
  for (int i = 0; i < 4; ++i) score.add(true, i < 1);      // 1 of 4 removed
  EXPECT_EQ(score.still, 100u);
  EXPECT_EQ(score.still_kept, 81u);
  EXPECT_EQ(score.moving, 4u);
  EXPECT_EQ(score.moving_removed, 1u);
  EXPECT_DOUBLE_EQ(score.staticAccuracy(), 0.81);
  EXPECT_DOUBLE_EQ(score.dynamicAccuracy(), 0.25);
  EXPECT_DOUBLE_EQ(score.associatedAccuracy(), 0.45);  // sqrt(0.81 * 0.25)
}

TEST(RemovalScoreTest, IsPerfectWhereThereIsNothingToFind) {
  RemovalScore score;
  EXPECT_EQ(score.associatedAccuracy(), 1.0);
  score.add(false, true);
  EXPECT_EQ(score.staticAccuracy(), 0.0);
  EXPECT_EQ(score.dynamicAccuracy(), 1.0);
  EXPECT_EQ(score.associatedAccuracy(), 0.0);
}

}  // namespace
}  // namespace gaussmap
