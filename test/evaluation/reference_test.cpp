// SPDX-License-Identifier: BSD-3-Clause
// Comparing with a mesh, with another map, and the single distances behind the numbers.
#include <gtest/gtest.h>

#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/mapping/build.h"
#include "mesh/mesh_distance.h"
#include "points/point_clouds.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::allPairs;
using test::cube;
using test::Points;

/// The rectangle [0, 2] x [0, 1] in the plane z = 0.
TriangleMesh rectangle() {
  return {{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

GaussianMap<3> mapOf(const Points& points) {
  return build<3>(points, MapOptions{0.1, 4, 3, 0.01});
}

SampleOptions fewSamples() {
  SampleOptions options;
  options.samples = 3000;
  options.at_least = 5;
  return options;
}

TEST(Reference, OfAMeshMeasuresToItsSurface) {
  // Over the middle of a face, beside an edge, beyond a corner: 3, 1 and 5 m away.
  const HausdorffResult result = Reference(rectangle(), 100).compare({{1.3, 0.4, -3}, {1, 2, 0}, {5, 1, 4}});
  EXPECT_EQ(result.forward.max, 5.0);
  EXPECT_EQ(result.forward.mean, 3.0);
  EXPECT_EQ(result.forward.count, 3u);
  EXPECT_EQ(result.backward.count, 100u);
}

TEST(Reference, OfAMeshMeasuresBackFromTheSamplesOfItsSurface) {
  const Points subject = cube(300, 1);
  const Reference reference(rectangle(), 400, 7);
  PointDistances distances;
  const HausdorffResult result = reference.compare(subject, 0, &distances);
  const std::vector<Eigen::Vector3d> samples = sampleSurface(rectangle(), 400, 7);
  ASSERT_EQ(reference.points(), Points(samples.begin(), samples.end()));
  EXPECT_EQ(distances.subject, subject);
  EXPECT_EQ(distances.forward, meshDistances(subject, rectangle()));
  const std::vector<double> backward = allPairs(reference.points(), subject);
  ASSERT_EQ(distances.backward.size(), backward.size());
  for (std::size_t i = 0; i < backward.size(); ++i) ASSERT_DOUBLE_EQ(distances.backward[i], backward[i]);
  EXPECT_EQ(result.forward.rms, summarise(distances.forward).rms);
  EXPECT_EQ(result.backward.q95, summarise(distances.backward).q95);
}

TEST(Reference, OfAMeshIsNearAMapOfItsSurface) {
  const std::vector<Eigen::Vector3d> samples = sampleSurface(rectangle(), 40000, 1);
  const GaussianMap<3> map = mapOf(Points(samples.begin(), samples.end()));
  const MapHausdorff result = Reference(rectangle(), 2000).compare(map, 0, fewSamples());
  EXPECT_LT(result.within_two_sigma.forward.max, 0.021);  // 2 sigma of 1 cm, all of it off the plane
  EXPECT_GT(result.within_two_sigma.forward.max, 0.015);
  EXPECT_LT(result.all.backward.q99, 0.1);
  EXPECT_LE(result.within_two_sigma.forward.count, result.all.forward.count);
}

TEST(Reference, OfAMapToItselfHasDistanceZero) {
  const GaussianMap<3> map = mapOf(cube(3000, 2));
  for (int scale = 0; scale < map.scales(); ++scale) {
    const Reference reference(sampleMap(map, scale, fewSamples()));
    const MapHausdorff result = reference.compare(map, scale, fewSamples());
    EXPECT_EQ(result.all.hausdorff(), 0.0);
    EXPECT_EQ(result.within_two_sigma.hausdorff(), 0.0);
    EXPECT_GT(result.within_two_sigma.forward.count, 0u);
    EXPECT_EQ(result.within_two_sigma.forward.count, result.within_two_sigma.backward.count);
  }
}

TEST(Reference, OfAMapComparesNearSamplesWithNearSamples) {
  const GaussianMap<3> map = mapOf(cube(3000, 3)), other = mapOf(cube(2500, 4, {0.4, 0, 0}));
  const MapSamples<3> mine = sampleMap(map, 1, fewSamples()), theirs = sampleMap(other, 1, fewSamples());
  const MapHausdorff result = Reference(theirs).compare(map, 1, fewSamples());
  const HausdorffResult all = hausdorff(mine.points, theirs.points), near = hausdorff(mine.within(2), theirs.within(2));
  EXPECT_EQ(result.all.forward.rms, all.forward.rms);
  EXPECT_EQ(result.all.backward.rms, all.backward.rms);
  EXPECT_EQ(result.within_two_sigma.forward.rms, near.forward.rms);
  EXPECT_EQ(result.within_two_sigma.backward.rms, near.backward.rms);
  EXPECT_EQ(result.within_two_sigma.backward.count, theirs.within(2).size());
}

TEST(Reference, GivesTheDistancesOfTheSamplesOneByOne) {
  const Points points = cube(2000, 5);
  const GaussianMap<3> map = mapOf(points);
  PointDistances distances;
  const MapHausdorff result = Reference(points).compare(map, 1, fewSamples(), &distances);
  EXPECT_EQ(distances.subject, sampleMap(map, 1, fewSamples()).points);
  EXPECT_EQ(distances.forward.size(), result.samples);
  EXPECT_EQ(distances.backward.size(), points.size());
  EXPECT_EQ(summarise(distances.forward).mean, result.all.forward.mean);
  EXPECT_EQ(summarise(distances.backward).mean, result.all.backward.mean);
  EXPECT_EQ(evaluateMap(map, 1, points, fewSamples()).all.forward.mean, result.all.forward.mean);
}

TEST(Reference, GivesTheSameBitsForAnyNumberOfThreads) {
  const Reference reference(rectangle(), 3000);
  PointDistances one, other;
  reference.compare(cube(3000, 6), 1, &one);
  for (const int threads : {2, 0}) {
    reference.compare(cube(3000, 6), threads, &other);
    EXPECT_EQ(one.forward, other.forward);
    EXPECT_EQ(one.backward, other.backward);
  }
}

TEST(Reference, MayBeCopiedAndOutliveTheOriginal) {
  std::unique_ptr<Reference> original = std::make_unique<Reference>(Points{{0, 0, 0}});
  const Reference copy = *original;
  original.reset();
  EXPECT_EQ(copy.compare({{0, 0, 2}}).hausdorff(), 2.0);
}

TEST(Reference, RefusesNothingAndWhatIsNotFinite) {
  EXPECT_THROW(Reference(Points{}), std::invalid_argument);
  EXPECT_THROW(Reference(MapSamples<3>{}), std::invalid_argument);
  EXPECT_THROW(Reference(TriangleMesh(), 10), std::invalid_argument);
  EXPECT_THROW(Reference(rectangle(), 0), std::invalid_argument);
  EXPECT_THROW(Reference(Points{{0, 0, std::nan("")}}), std::invalid_argument);
  const Reference reference(rectangle(), 10);
  EXPECT_THROW(reference.compare(Points()), std::invalid_argument);
  EXPECT_THROW(reference.compare({{0, std::nan(""), 0}}), std::invalid_argument);
  EXPECT_THROW(reference.compare(GaussianMap<3>(), 0), std::invalid_argument);
  EXPECT_THROW(reference.compare(mapOf(cube(10, 1)), 3), std::out_of_range);
}

TEST(Hausdorff, GivesTheDistancesOneByOneOnRequest) {
  const Points a = cube(500, 7), b = cube(700, 8);
  PointDistances distances;
  const HausdorffResult result = hausdorff(a, b, 0, &distances);
  EXPECT_EQ(distances.subject, a);
  EXPECT_EQ(distances.forward.size(), a.size());
  EXPECT_EQ(distances.backward.size(), b.size());
  EXPECT_EQ(summarise(distances.forward).rms, result.forward.rms);
  EXPECT_EQ(summarise(distances.backward).rms, result.backward.rms);
}

}  // namespace
}  // namespace gaussmap
