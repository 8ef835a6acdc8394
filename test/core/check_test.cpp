// SPDX-License-Identifier: BSD-3-Clause
#include "core/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace gaussmap::detail {
namespace {

std::string refusalOf(double value) {
  try {
    require(false, "cell", value, "must be positive");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Check, NamesTheOptionItsValueAndWhatIsRequired) {
  EXPECT_EQ(refusalOf(-1.0), "cell = -1: must be positive");
  EXPECT_EQ(refusalOf(-0.5), "cell = -0.5: must be positive");
  EXPECT_EQ(refusalOf(std::nan("")), "cell = nan: must be positive");
}

TEST(Check, AcceptsAUsableValue) {
  EXPECT_NO_THROW(require(true, "cell", 1.0, "must be positive"));
}

TEST(NumberText, IsTheShortestThatGivesBackTheNumber) {
  EXPECT_EQ(numberText(1e-9), "1e-09");
  EXPECT_EQ(numberText(0.25), "0.25");
  EXPECT_EQ(numberText(0.1), "0.1");
  EXPECT_EQ(numberText(3.0), "3");
  EXPECT_EQ(numberText(0.0), "0");
  for (const double value : {1.0 / 3.0, 1e300, std::numeric_limits<double>::min(), -123456.789})
    EXPECT_EQ(std::stod(numberText(value)), value);
}

TEST(NumberText, WritesWholeNumbersWithoutAnExponent) {
  EXPECT_EQ(numberText(100000.0), "100000");
  EXPECT_EQ(numberText(-4294967296.0), "-4294967296");
  EXPECT_EQ(numberText(1e18), "1e+18");
}

TEST(NumberText, NamesWhatIsNotFinite) {
  EXPECT_EQ(numberText(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(numberText(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(numberText(std::nan("")), "nan");
  EXPECT_EQ(numberText(-std::nan("")), "nan");
}

}  // namespace
}  // namespace gaussmap::detail
