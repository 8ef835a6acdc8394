// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/pose.h"

#include <gtest/gtest.h>

#include <string>

namespace gaussmap {
namespace {

/// Returns the fault of a pose with this quaternion.
std::string faultOf(double x, double y, double z, double w) {
  return poseFault({{1.0, 2.0, 3.0}, Pose::Rotation(w, x, y, z)});
}

TEST(PoseFault, IsEmptyForAUnitQuaternion) {
  EXPECT_EQ(faultOf(0.0, 0.0, 0.1908, 0.9816), "");  // four decimals are enough
}

TEST(PoseFault, AsksForMoreDigitsOnlyIfTheNormIsNearlyOne) {
  const std::string rounded = faultOf(0.0, 0.0, 0.19, 0.98), wrong = faultOf(0.5, 0.5, 0.5, 0.1);
  EXPECT_NE(rounded.find("instead of 1: check the order of its numbers, or give more digits"), std::string::npos)
      << rounded;
  EXPECT_NE(wrong.find("instead of 1: check the order of its numbers"), std::string::npos) << wrong;
  EXPECT_EQ(wrong.find("digits"), std::string::npos) << wrong;
}

}  // namespace
}  // namespace gaussmap
