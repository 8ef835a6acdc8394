// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/evaluation/hausdorff.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/mapping/build.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

using Points = std::vector<Vector<3>>;

Points randomPoints(std::size_t count, std::uint64_t seed, const Vector<3>& centre = Vector<3>::Zero()) {
  Random random(seed);
  Points points(count);
  for (Vector<3>& point : points)
    for (int axis = 0; axis < 3; ++axis) point(axis) = centre(axis) + random.uniform();
  return points;
}

/// The unit square in the plane z, (n + 1)^2 points on it.
Points square(double x, double z, int n) {
  Points points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) points.emplace_back(x + double(i) / n, double(j) / n, z);
  return points;
}

void expectBruteForce(const Points& from, const Points& to) {
  const std::vector<double> distances = nearestDistances(from, to);
  ASSERT_EQ(distances.size(), from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector<3>& point : to) nearest = std::min(nearest, (from[i] - point).norm());
    ASSERT_NEAR(distances[i], nearest, 1e-12 * (1.0 + nearest)) << "point " << i;
  }
}

TEST(NearestDistances, AreThoseOfAllPairs) {
  expectBruteForce(randomPoints(3000, 1), randomPoints(4000, 2));
}

TEST(NearestDistances, AreThoseOfAllPairsForQueriesFarOutside) {
  Points far = randomPoints(500, 3);
  for (Vector<3>& point : far) point = 100.0 * (point - Vector<3>(0.5, 0.5, 0.5));
  expectBruteForce(far, randomPoints(2000, 4));
}

TEST(NearestDistances, AreThoseOfAllPairsWithDuplicates) {
  Points to = randomPoints(500, 5);
  for (int copy = 0; copy < 4; ++copy) to.insert(to.end(), to.begin(), to.begin() + 500);
  Points from = randomPoints(1000, 6);
  from.insert(from.end(), to.begin(), to.begin() + 500);
  expectBruteForce(from, to);
}

TEST(NearestDistances, AreThoseOfAllPairsOnALineAndOnAPlane) {
  Points line = randomPoints(2000, 7), plane = randomPoints(2000, 8);
  for (Vector<3>& point : line) point = Vector<3>(0.1, 0.2, 0.3) + point.x() * Vector<3>(1, 2, -1);
  for (Vector<3>& point : plane) point.z() = 0.25;
  expectBruteForce(line, plane);
  expectBruteForce(plane, line);
  expectBruteForce(line, line);
}

TEST(NearestDistances, LoseNothingTenThousandKilometresAway) {
  const Vector<3> far(1e7, -1e7, 1e7);
  expectBruteForce(randomPoints(1000, 9, far), randomPoints(2000, 10, far));
  const Points a = {far}, b = {far + Vector<3>(0, 0.0009765625, 0)};  // 2^-10 m, exact in doubles there
  EXPECT_EQ(nearestDistances(a, b).front(), 0.0009765625);
}

TEST(NearestDistances, OfPointsAtExponentiallyGrowingGapsAreThoseOfAllPairs) {  // the deepest tree there can be
  Points to;
  for (int power = -1000; power < 10; ++power) to.emplace_back(std::ldexp(1.0, power), 0, 0);
  expectBruteForce(randomPoints(200, 11), to);
}

TEST(NearestDistances, ToOnePointAreItsDistances) {
  const std::vector<double> distances = nearestDistances({{3, 0, 0}, {0, 4, 0}, {0, 0, 0}}, {{0, 0, 0}});
  EXPECT_EQ(distances, (std::vector<double>{3.0, 4.0, 0.0}));
}

TEST(NearestDistances, DoNotDependOnThreads) {
  const Points from = randomPoints(20000, 12), to = randomPoints(20000, 13);
  const std::vector<double> one = nearestDistances(from, to, 1);
  EXPECT_EQ(one, nearestDistances(from, to, 2));
  EXPECT_EQ(one, nearestDistances(from, to, 0));
}

TEST(NearestDistances, DoNotDependOnTheOrderOfTheTarget) {
  const Points from = randomPoints(3000, 14);
  Points to = randomPoints(3000, 15);
  const std::vector<double> forward = nearestDistances(from, to);
  std::reverse(to.begin(), to.end());
  EXPECT_EQ(forward, nearestDistances(from, to));
}

TEST(NearestDistances, ToAHundredThousandEqualPointsAreQuick) {  // quadratic would be 10^10 distances
  const Points heap(100000, Vector<3>(1, 2, 3));
  Points from = randomPoints(100000, 16);
  from.front() = heap.front();
  const auto start = std::chrono::steady_clock::now();
  const std::vector<double> distances = nearestDistances(from, heap);
  const std::vector<double> to_themselves = nearestDistances(heap, heap);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  EXPECT_LT(time.count(), 5.0);
  EXPECT_EQ(distances.front(), 0.0);
  EXPECT_DOUBLE_EQ(distances.back(), (from.back() - heap.front()).norm());
  EXPECT_EQ(to_themselves, std::vector<double>(heap.size(), 0.0));
}

TEST(NearestDistances, RefuseNothingAndNameThePointThatIsNotFinite) {
  EXPECT_TRUE(nearestDistances({}, {}).empty());
  EXPECT_THROW(nearestDistances({{0, 0, 0}}, {}), std::invalid_argument);
  Points bad = randomPoints(10, 17);
  bad[7].y() = std::numeric_limits<double>::quiet_NaN();
  try {
    nearestDistances(randomPoints(1, 1), bad);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("point 7 of 'to'"), std::string::npos) << error.what();
  }
  bad[7].y() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(nearestDistances(bad, randomPoints(1, 1)), std::invalid_argument);
}

TEST(Summary, OfOneToAHundredHasTheQuantilesOfNearestRank) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  const DistanceSummary summary = summarise(values);
  EXPECT_EQ(summary.max, 100.0);
  EXPECT_EQ(summary.q99, 99.0);
  EXPECT_EQ(summary.q95, 95.0);
  EXPECT_DOUBLE_EQ(summary.mean, 50.5);
  EXPECT_DOUBLE_EQ(summary.rms, std::sqrt(3383.5));  // 101 * 201 / 6
  EXPECT_EQ(summary.count, 100u);
}

TEST(Summary, TakesTheNextRankUpBetweenRanks) {  // ceil(0.95 * 21) = 20, ceil(0.99 * 21) = 21
  std::vector<double> values;
  for (int i = 1; i <= 21; ++i) values.push_back(i);
  EXPECT_EQ(summarise(values).q95, 20.0);
  EXPECT_EQ(summarise(values).q99, 21.0);
  EXPECT_EQ(summarise({7.0}).q95, 7.0);
  EXPECT_EQ(summarise({7.0}).q99, 7.0);
}

TEST(Summary, OfNothingIsRefused) {
  EXPECT_THROW(summarise({}), std::invalid_argument);
}

TEST(Hausdorff, OfTwoPointsIsTheirDistance) {
  const HausdorffResult result = hausdorff({{1, 1, 1}}, {{1, 4, 1}});
  EXPECT_EQ(result.hausdorff(), 3.0);
  EXPECT_EQ(result.forward.rms, 3.0);
  EXPECT_EQ(result.backward.q95, 3.0);
}

TEST(Hausdorff, OfASquareAndTheSquareHalfAMetreAboveIsHalfAMetre) {
  const HausdorffResult result = hausdorff(square(0, 0, 10), square(0, 0.5, 10));
  for (const DistanceSummary* side : {&result.forward, &result.backward}) {
    EXPECT_EQ(side->max, 0.5);
    EXPECT_EQ(side->mean, 0.5);
    EXPECT_EQ(side->count, 121u);
  }
}

TEST(Hausdorff, OfASquareShiftedWithinItsPlaneIsTheShift) {
  // Shifted by 2 of 10 steps: columns 0 ... 8 coincide, the outer two are 0.1 and 0.2 away: of 11 x 11 points.
  const HausdorffResult result = hausdorff(square(0, 0, 10), square(0.2, 0, 10));
  EXPECT_NEAR(result.hausdorff(), 0.2, 1e-15);
  EXPECT_NEAR(result.forward.mean, 0.3 / 11, 1e-15);
  EXPECT_NEAR(result.backward.mean, 0.3 / 11, 1e-15);
}

TEST(Hausdorff, KeepsTheDirectionsApart) {  // a is part of b: nothing invented, one point missed
  const Points a = {{0, 0, 0}}, b = {{0, 0, 0}, {0, 0, 2}};
  const HausdorffResult result = hausdorff(a, b);
  EXPECT_EQ(result.forward.max, 0.0);
  EXPECT_EQ(result.backward.max, 2.0);
  EXPECT_EQ(result.backward.mean, 1.0);
  EXPECT_EQ(result.hausdorff(), 2.0);
}

TEST(Hausdorff, OfAnEmptySetIsRefused) {
  EXPECT_THROW(hausdorff({}, {{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(hausdorff({{0, 0, 0}}, {}), std::invalid_argument);
}

TEST(EvaluateMap, FindsAMapOfAPlaneNearThePlane) {
  Points plane;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 200; ++j) plane.emplace_back(0.005 + 0.01 * i, 0.005 + 0.01 * j, 0.05);
  MapOptions map_options;
  map_options.scales = 2;
  map_options.noise = 0.002;
  const GaussianMap<3> map = build<3>(plane, map_options);
  SampleOptions options;
  options.samples = 20000;
  const MapHausdorff result = evaluateMap(map, 0, plane, options);
  EXPECT_EQ(result.gaussians, 400u);
  EXPECT_EQ(result.samples, result.all.forward.count);
  EXPECT_EQ(result.all.backward.count, plane.size());
  EXPECT_LT(result.within_two_sigma.forward.count, result.samples);
  // z is at most 2 sigma = 4 mm off, x and y lie between the points of a grid of 1 cm
  EXPECT_LT(result.within_two_sigma.forward.max, std::sqrt(2 * 0.005 * 0.005 + 0.004 * 0.004) + 1e-9);
  EXPECT_LE(result.within_two_sigma.forward.max, result.all.forward.max);
  EXPECT_LT(result.all.backward.q99, 0.05);
}

TEST(EvaluateMap, ComparesTheSamplesThatSampleMapGives) {
  const Points points = randomPoints(2000, 18);
  const GaussianMap<3> map = build<3>(points, MapOptions{0.1, 10, 2, 0.01});
  SampleOptions options;
  options.samples = 3000;
  const MapSamples<3> samples = sampleMap(map, 1, options);
  const MapHausdorff result = evaluateMap(map, 1, points, options);
  const HausdorffResult all = hausdorff(samples.points, points), near = hausdorff(samples.within(2.0), points);
  EXPECT_EQ(result.samples, samples.points.size());
  EXPECT_EQ(result.all.forward.rms, all.forward.rms);
  EXPECT_EQ(result.all.backward.max, all.backward.max);
  EXPECT_EQ(result.within_two_sigma.forward.mean, near.forward.mean);
  EXPECT_EQ(result.within_two_sigma.backward.mean, near.backward.mean);
}

TEST(EvaluateMap, RefusesEmptyMapsAndReferencesAndScalesThatAreNotThere) {
  const GaussianMap<3> map = build<3>(randomPoints(10, 19), MapOptions{});
  EXPECT_THROW(evaluateMap(map, 0, {}), std::invalid_argument);
  EXPECT_THROW(evaluateMap(map, 3, {{0, 0, 0}}), std::out_of_range);
  EXPECT_THROW(evaluateMap(map, -1, {{0, 0, 0}}), std::out_of_range);
  EXPECT_THROW(evaluateMap(GaussianMap<3>(), 0, {{0, 0, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
