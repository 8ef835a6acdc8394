// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/written_position.h"

#include <gtest/gtest.h>

namespace gaussmap::detail {
namespace {

TEST(WrittenPosition, HasTheStepOfItsLastDigitIfItLooksRounded) {
  EXPECT_DOUBLE_EQ(stepOfRoundedPosition({"455123", "5.40457e+06", "311.5"}), 10.0);               // "%g"
  EXPECT_DOUBLE_EQ(stepOfRoundedPosition({"4.551234e+05", "5.404568e+06", "3.115000e+02"}), 1.0);  // "%.6e"
  EXPECT_DOUBLE_EQ(stepOfRoundedPosition({"-45512.3", "-812.7", "3"}), 0.1);
}

TEST(WrittenPosition, IsNotRoundedIfAnyNumberHasMoreDigits) {
  EXPECT_EQ(stepOfRoundedPosition({"455123", "5404567.85", "311.5"}), 0.0);
  EXPECT_EQ(stepOfRoundedPosition({"455123.0", "5404570.0", "310.0"}), 0.0);  // a fixed number of decimals
  EXPECT_EQ(stepOfRoundedPosition({"4.55123400e+05", "5.40456785e+06", "310"}), 0.0);
}

TEST(WrittenPosition, IsNotRoundedNearTheOriginOrWithFewDigits) {
  EXPECT_EQ(stepOfRoundedPosition({"12.3456", "-7.25", "0"}), 0.0);
  EXPECT_EQ(stepOfRoundedPosition({"500000", "5000", "0"}), 0.0);  // whole numbers that somebody chose
  EXPECT_EQ(stepOfRoundedPosition({"nan", "", "x"}), 0.0);
}

TEST(WrittenPosition, WarnsIfHalfOfThePositionsAndAtLeastTwoAreRounded) {
  RoundedPositions positions;
  positions.add(10.0, 455123, 5404570, 311.5);
  EXPECT_EQ(positions.warning(), "");
  positions.add(10.0, 455133, 5404580, 311.5);
  EXPECT_EQ(
      positions.warning(),
      "the positions are rounded to steps of 10 m, because they were written with too few digits; write at least 9");
  for (int i = 0; i < 3; ++i) positions.add(0.0, 1, 2, 3);
  EXPECT_EQ(positions.warning(), "");
}

}  // namespace
}  // namespace gaussmap::detail
