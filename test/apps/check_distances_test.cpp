// SPDX-License-Identifier: BSD-3-Clause
// FLANN's exact kd-tree as an independent twin of the search of hausdorff(), and the comparison of `hausdorff --check`.
#include "commands/hausdorff/check_distances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "points/point_clouds.h"

namespace gaussmap::app {
namespace {

using test::cube;
using test::Points;

Points moved(Points points, const Vector<3>& by, double height = 1.0) {
  for (Vector<3>& point : points) point = Vector<3>(point.x(), point.y(), height * point.z()) + by;
  return points;
}

/// Expects that both searches find the same distances.
void expectAgreement(const Points& a, const Points& b) {
  PointDistances distances;
  const HausdorffResult result = hausdorff(a, b, 2, &distances);
  EXPECT_EQ(checkDistances(b, distances, 2), a.size() + b.size());
  EXPECT_EQ(checkMaxima(a, b, {result.forward.max, result.backward.max}, 1), a.size() + b.size());
}

TEST(FlannDistances, AreThoseOfTheHausdorffSearch) {
  expectAgreement(cube(3000, 1), cube(2500, 2));                                                   // a volume
  expectAgreement(moved(cube(3000, 3), {0, 0, 0}, 1e-3), moved(cube(3000, 4), {0.2, 0, 0}, 0.0));  // surfaces
  expectAgreement(cube(500, 5), moved(cube(500, 6), {300, 0, 0}));  // far from each other
  const Vector<3> far(4e6, -5e6, 10.0);
  expectAgreement(moved(cube(2000, 7), far), moved(cube(2000, 8), far));  // far from the origin
}

TEST(FlannDistances, AreThoseOfTheHausdorffSearchForEqualPoints) {
  Points equal(1000, Vector<3>(1, 2, 3));
  expectAgreement(equal, equal);
  expectAgreement(equal, {{0, 0, 0}});
  Points mixed = cube(500, 9);
  mixed.insert(mixed.end(), equal.begin(), equal.end());
  expectAgreement(mixed, cube(700, 10));
}

TEST(FlannDistances, AreThoseOfTheHausdorffSearchForPointsThatAreDifficultForTrees) {
  for (const auto& pair : test::hostilePairs()) {
    SCOPED_TRACE(pair.name);
    expectAgreement(pair.a, pair.b);
  }
}

TEST(FlannDistances, AreKnownOnPaper) {
  EXPECT_EQ(flannDistances({{3, 4, 0}, {0, 0, 2}}, {{0, 0, 0}, {0, 0, 5}}, 1), (std::vector<double>{5.0, 2.0}));
}

/// Returns the message of the error; empty if `check` throws no error.
std::string errorOf(const std::vector<double>& distances, const std::vector<double>& again) {
  try {
    requireSame(distances, again, "subject");
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(RequireSame, FindsADistanceThatIsWrong) {
  const Points a = cube(200, 11), b = cube(200, 12);
  PointDistances distances;
  hausdorff(a, b, 1, &distances);
  EXPECT_EQ(errorOf(distances.forward, flannDistances(a, b, 1)), "");
  distances.forward[17] *= 1.0 + 1e-9;
  const std::string message = errorOf(distances.forward, flannDistances(a, b, 1));
  EXPECT_NE(message.find("point 17 of the subject"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_THROW(checkDistances(b, distances, 1), std::runtime_error);
  distances.forward[17] = 0.0;
  EXPECT_THROW(checkDistances(b, distances, 1), std::runtime_error);
}

TEST(RequireSame, AllowsRoundingOnly) {
  EXPECT_EQ(errorOf({0.0, 1.0, 3e-9}, {0.0, 1.0 + 1e-15, 3e-9}), "");
  EXPECT_NE(errorOf({0.0}, {1e-300}), "");
  EXPECT_NE(errorOf({1.0}, {1.0 + 1e-11}), "");
  EXPECT_NE(errorOf({1.0}, {std::numeric_limits<double>::quiet_NaN()}), "");
  EXPECT_NE(errorOf({std::numeric_limits<double>::quiet_NaN()}, {1.0}), "");
  EXPECT_NE(errorOf({1.0}, {1.0, 1.0}), "");  // another number of distances
}

TEST(CheckMaxima, FindsAMaximumThatIsWrong) {
  const Points a = cube(200, 13), b = cube(200, 14);
  HausdorffMaxima maxima = hausdorffMaxima(a, b);
  EXPECT_EQ(checkMaxima(a, b, maxima, 1), 400u);
  maxima.backward *= 0.999;
  EXPECT_THROW(checkMaxima(a, b, maxima, 1), std::runtime_error);
}

}  // namespace
}  // namespace gaussmap::app
