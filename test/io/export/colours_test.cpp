// SPDX-License-Identifier: BSD-3-Clause
#include "io/export/colours.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gaussmap::test {
using namespace detail;

namespace {

TEST(Colours, ViridisRunsFromDarkToBrightAndStaysAtItsEnds) {
  EXPECT_EQ(viridis(0.0), (Colour{68, 1, 84}));
  EXPECT_EQ(viridis(1.0), (Colour{253, 231, 37}));
  EXPECT_EQ(viridis(-3.0), viridis(0.0));
  EXPECT_EQ(viridis(HUGE_VAL), viridis(1.0));
  EXPECT_EQ(viridis(std::nan("")), viridis(0.0));
  for (double place = 0.0; place < 0.99; place += 0.01) EXPECT_LE(viridis(place)[1], viridis(place + 0.01)[1]);
}

TEST(Colours, ANormalAndItsOppositeHaveOneColour) {
  const Vector<3> normal = Vector<3>(1, 2, -3).normalized();
  EXPECT_EQ(normalColour(normal), normalColour(-normal));
  EXPECT_NE(normalColour({1, 0, 0}), normalColour({0, 1, 0}));
  EXPECT_NE(normalColour({1, 0, 0}), normalColour({0, 0, 1}));
}

TEST(Colours, ARangeLeavesOutTheOutermostAndWhatIsNotFinite) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(i);
  values[500] = std::nan("");
  EXPECT_EQ(colourRange(values).first, 9.0 + 0.0);
  EXPECT_EQ(colourRange(values).second, 991.0);
  EXPECT_EQ(colourRange({2.0, 2.0}), std::make_pair(1.5, 2.5));
  EXPECT_EQ(colourRange({}), std::make_pair(0.0, 1.0));
}

}  // namespace
}  // namespace gaussmap::test
