// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/colouring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gaussmap/mapping/build.h"
#include "map/random_clouds.h"

namespace gaussmap::test {
using namespace detail;

namespace {

/// Two boards at heights 0 and 3 m, of 100 and of 900 points a cell, in cells of 1 and 4 m.
GaussianMap<3> boards() {
  std::vector<Vector<3>> points;
  for (const auto& [height, steps] : {std::pair(0.2, 10), std::pair(3.2, 30)})
    for (int x = 0; x < 3 * steps; ++x)
      for (int y = 0; y < 3 * steps; ++y) points.emplace_back((x + 0.5) / steps, (y + 0.5) / steps, height);
  return build<3>(points, {1.0, 4, 2, 0.0});
}

TEST(Colouring, GoesByTheValueAndSaysItsRange) {
  const GaussianMap<3> map = boards();
  const std::vector<GaussianId> all = gaussiansOfScale(map, 0);
  const Colouring height = colouringOf(map, all, {ColourBy::Height, Vector<3>::UnitZ()}, {});
  EXPECT_EQ(height.title, "height [m]");
  EXPECT_NEAR(height.low, 0.2, 1e-3);
  EXPECT_NEAR(height.high, 3.2, 1e-3);
  const Colouring weight = colouringOf(map, all, {ColourBy::Weight, Vector<3>::UnitZ()}, {});
  EXPECT_NEAR(weight.low, 2.0, 1e-9);
  EXPECT_NEAR(weight.high, std::log10(900.0), 1e-9);
  const Colouring normal = colouringOf(map, all, {ColourBy::Normal, Vector<3>::UnitZ()}, {});
  ASSERT_EQ(all.size(), 18u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool low = map.gaussian(i, 0).mean.z() < 1.0;
    EXPECT_EQ(height.colours[i], viridis(low ? 1.0 : 0.0));  // the ground is bright
    EXPECT_EQ(weight.colours[i], viridis(low ? 0.0 : 1.0));
    EXPECT_EQ(normal.colours[i], normalColour({0, 0, 1}));
  }
  EXPECT_EQ(normal.names.size(), normal.bar.size());
  const Colouring along_x = colouringOf(map, all, {ColourBy::Height, Vector<3>::UnitX()}, {});
  EXPECT_NEAR(along_x.high, 2.5, 1e-3);
}

TEST(Colouring, EveryScaleHasItsOwnColour) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(500, 1), {0.25, 2, 4, 0.0});
  std::vector<GaussianId> one_each;
  for (int s = 0; s < 4; ++s) one_each.push_back({s, 0});
  const Colouring colouring = colouringOf(map, one_each, {ColourBy::Scale, Vector<3>::UnitZ()}, {});
  EXPECT_EQ(std::set<Colour>(colouring.colours.begin(), colouring.colours.end()).size(), 4u);
  EXPECT_EQ(colouring.names, (std::vector<std::string>{"0 (0.25 m)", "1 (0.5 m)", "2 (1 m)", "3 (2 m)"}));
  EXPECT_EQ(colouring.colours, colouring.bar);
}

TEST(Colouring, WhatIsNotFiniteIsGrey) {
  const GaussianMap<3> map = boards();
  const Colouring colouring =
      colouringOf(map, {{0, 0}, {0, 1}, {0, 2}}, {ColourBy::Error, Vector<3>::UnitZ()}, {std::nan(""), 0.0, 0.5});
  EXPECT_EQ(colouring.colours[0], (Colour{150, 150, 150}));
  EXPECT_GT(colouring.colours[1][2], colouring.colours[1][0]);  // blue
  EXPECT_GT(colouring.colours[2][0], colouring.colours[2][2]);  // red
  EXPECT_EQ(colouring.low, 0.0);
  EXPECT_EQ(colouring.high, 0.5);
}

/// Two cells of 4 m over cells of 1 m. Their clusters are 1 m from each of the finer Gaussians of the left cell, which
/// is 10 and 5 deviations, and exact in the right cell.
GaussianMap<3> leftAndRight() {
  const auto at = [](double x, double y, double z, double deviation) {
    return Gaussian<3>{{x, y, z}, deviation * deviation * Matrix<3>::Identity(), 1.0};
  };
  MapScale<3> fine, coarse;
  fine.keys = {{0, 0, 0}, {2, 0, 0}, {5, 0, 0}};
  fine.gaussians = {at(0, 0, 0, 0.1), at(0, 0, 0, 0.2), at(0, 0, 0, 0.1)};
  fine.parent = {0, 0, 1};
  coarse.keys = {{0, 0, 0}, {1, 0, 0}};
  coarse.first_child = {0, 2, 3};
  coarse.gaussians = {at(-0.5, -1.5, -1.5, 1.0), at(-0.5, -1.5, -1.5, 0.1)};
  return GaussianMap<3>({1.0, 4, 2, 0.0}, {fine, coarse});
}

TEST(Colouring, OfErrorsOfCellsIsLogarithmic) {
  const GaussianMap<3> map = leftAndRight();
  const std::vector<double> fine = contributions(map, 0), coarse = errorsOfCells(map, 1);
  ASSERT_EQ(fine.size(), 3u);
  EXPECT_NEAR(fine[0], 100.0, 1e-9);
  EXPECT_NEAR(fine[1], 25.0, 1e-9);
  EXPECT_NEAR(fine[2], 0.0, 1e-9);
  ASSERT_EQ(coarse.size(), 2u);
  EXPECT_NEAR(coarse[0], 62.5, 1e-9);
  EXPECT_NEAR(coarse[1], 0.0, 1e-9);
  for (const double error : contributions(map, 1)) EXPECT_TRUE(std::isnan(error));
  for (const double error : errorsOfCells(map, 0)) EXPECT_TRUE(std::isnan(error));

  const std::vector<GaussianId> five(5);
  const Colouring colouring =
      colouringOf(map, five, {ColourBy::Contribution, Vector<3>::UnitZ()}, {1.0, 10.0, 100.0, 0.0, std::nan("")});
  EXPECT_TRUE(colouring.is_logarithmic);
  EXPECT_EQ(colouring.low, 1.0);
  EXPECT_EQ(colouring.high, 100.0);
  EXPECT_EQ(colouring.colours[0], viridis(1.0));  // large errors are dark
  EXPECT_EQ(colouring.colours[1], viridis(0.5));  // 10 is halfway from 1 to 100
  EXPECT_EQ(colouring.colours[2], viridis(0.0));
  EXPECT_EQ(colouring.colours[3], viridis(1.0));  // no error
  EXPECT_EQ(colouring.colours[4], (Colour{150, 150, 150}));
  EXPECT_EQ(colouring.bar.front(), viridis(1.0 - 0.5 / 256));
}

TEST(Colouring, LogarithmicRangesHaveLimits) {
  using Range = std::pair<double, double>;
  EXPECT_EQ(logColourRange({3.0, 1e9, 2e9, -1.0, 0.0, std::nan("")}), Range(2e5, 2e9));
  EXPECT_EQ(logColourRange({5.0, 20.0}), Range(5.0, 20.0));
  EXPECT_EQ(logColourRange({6.0, 6.0}), Range(3.0, 12.0));
  EXPECT_EQ(logColourRange({0.0, HUGE_VAL}), Range(0.1, 10.0));
}

TEST(GaussianErrors, AreTheMeanDistanceToTheCloudOrElseToTheFinerDetail) {
  const GaussianMap<3> map = boards();
  std::vector<Vector<3>> cloud;  // 0.5 m above the lower board
  for (int x = -50; x < 350; x += 2)
    for (int y = -50; y < 350; y += 2) cloud.emplace_back(0.01 * x, 0.01 * y, 0.7);
  const std::vector<double> errors = gaussianErrors(map, 0, cloud);
  ASSERT_EQ(errors.size(), 18u);
  for (std::size_t i = 0; i < errors.size(); ++i)
    EXPECT_NEAR(errors[i], map.gaussian(i, 0).mean.z() < 1.0 ? 0.5 : 2.5, 0.02);
  for (const double error : gaussianErrors(map, 1, {})) EXPECT_GT(error, 0.2);  // one for two boards 3 m apart
  for (const double error : gaussianErrors(map, 0, {})) EXPECT_TRUE(std::isnan(error));
}

}  // namespace
}  // namespace gaussmap::test
