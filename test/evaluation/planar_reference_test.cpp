// SPDX-License-Identifier: BSD-3-Clause
// Comparing planar maps and clouds: the distances are those in the plane, beside a search through all pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "editing/thinned_map.h"
#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/evaluation/held_out.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

using test::randomCloud;
using PlanarPoints = std::vector<Vector<2>>;

/// Distances from each point to the nearest of other points, by looking at all.
std::vector<double> allDistances(const PlanarPoints& from, const PlanarPoints& to) {
  std::vector<double> distances;
  for (const Vector<2>& point : from) {
    double square = std::numeric_limits<double>::infinity();
    for (const Vector<2>& other : to) square = std::min(square, (other - point).squaredNorm());
    distances.push_back(std::sqrt(square));
  }
  return distances;
}

void expectEqual(const DistanceSummary& found, const DistanceSummary& expected) {
  EXPECT_EQ(found.count, expected.count);
  EXPECT_DOUBLE_EQ(found.max, expected.max);
  EXPECT_DOUBLE_EQ(found.q95, expected.q95);
  EXPECT_DOUBLE_EQ(found.mean, expected.mean);
}

SampleOptions planarSampling() {
  SampleOptions options;
  options.samples = 1500;
  options.at_least = 3;
  return options;
}

GaussianMap<2> planarMap(std::uint64_t seed) {
  return refine<2>(build<2>(randomCloud<2>(1500, seed), {0.1, 4, 3, 0.0}), PerCell{2.0}).map;
}

TEST(PlanarHausdorff, IsThatOfAllPairs) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    PlanarPoints a = randomCloud<2>(700, seed), b = randomCloud<2>(900, 50 + seed);
    if (seed == 5)  // far from the origin
      for (PlanarPoints* points : {&a, &b})
        for (Vector<2>& point : *points) point += Vector<2>(4.5e6, 5.4e6);
    PointDistances distances;
    const HausdorffResult result = hausdorff(a, b, 0, &distances);
    const std::vector<double> forward = allDistances(a, b), backward = allDistances(b, a);
    expectEqual(result.forward, summarise(forward));
    expectEqual(result.backward, summarise(backward));
    const HausdorffMaxima maxima = hausdorffMaxima(a, b);
    EXPECT_EQ(maxima.forward, result.forward.max);
    EXPECT_EQ(maxima.backward, result.backward.max);
    ASSERT_EQ(distances.subject.size(), a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(distances.subject[i], Vector<3>(a[i].x(), a[i].y(), 0.0));
      EXPECT_DOUBLE_EQ(distances.forward[i], forward[i]);
    }
  }
}

TEST(PlanarReference, ComparesSamplesOfEveryScale) {
  const GaussianMap<2> map = planarMap(7);
  const PlanarPoints points = randomCloud<2>(1500, 7);
  const Reference reference(points);
  for (int s = 0; s < map.scales(); ++s) {
    const MapSamples<2> samples = sampleMap(map, s, planarSampling());
    const MapHausdorff result = reference.compare(map, s, planarSampling());
    EXPECT_EQ(result.samples, samples.points.size());
    EXPECT_EQ(result.gaussians, map.gaussianCount(s));
    expectEqual(result.all.forward, summarise(allDistances(samples.points, points)));
    expectEqual(result.all.backward, summarise(allDistances(points, samples.points)));
    expectEqual(result.within_two_sigma.forward, summarise(allDistances(samples.within(2.0), points)));
    expectEqual(evaluateMap(map, s, points, planarSampling()).all.forward, result.all.forward);
  }
  expectEqual(reference.compare(points).forward, summarise(std::vector<double>(points.size(), 0.0)));
}

TEST(PlanarReference, ComparesLeavesAndMaps) {
  const GaussianMap<2> map = test::thinned(planarMap(8)), other = planarMap(9);
  const MapSamples<2> mine = sampleLeaves(map, planarSampling()), theirs = sampleLeaves(other, planarSampling());
  const MapHausdorff result = Reference(theirs).compareLeaves(map, planarSampling());
  EXPECT_EQ(result.gaussians, leaves(map).size());
  expectEqual(result.all.forward, summarise(allDistances(mine.points, theirs.points)));
  expectEqual(result.within_two_sigma.backward, summarise(allDistances(theirs.within(2.0), mine.within(2.0))));
}

TEST(PlanarReference, OfAMeshHasDistancesInSpace) {  // a wall at x = 2 that ends 0.3 m above the plane
  const TriangleMesh wall{{{2, -50, 0.3}, {2, 50, 0.3}, {2, 50, 3}, {2, -50, 3}}, {{0, 1, 2}, {0, 2, 3}}};
  const HausdorffResult result = Reference(wall, 100).compare(PlanarPoints{{2, 1}, {2.4, -7}});
  EXPECT_NEAR(result.forward.max, 0.5, 1e-12);
  EXPECT_NEAR(result.forward.mean, 0.4, 1e-12);
}

TEST(PlanarReference, RefusesWhatHasNoDistance) {
  EXPECT_THROW(Reference(PlanarPoints{}), std::invalid_argument);
  EXPECT_THROW(Reference(MapSamples<2>{}), std::invalid_argument);
  EXPECT_THROW(hausdorff(PlanarPoints{{0, 0}}, PlanarPoints{}), std::invalid_argument);
  EXPECT_THROW(evaluateMap(GaussianMap<2>(), 0, PlanarPoints{{0, 0}}), std::invalid_argument);
  EXPECT_THROW(evaluateMap(planarMap(1), 3, PlanarPoints{{0, 0}}), std::out_of_range);
  try {
    hausdorff(PlanarPoints{{0, 0}, {0, 1}}, PlanarPoints{{0, 0}, {1, 1}, {0, std::nan("")}});
    ADD_FAILURE() << "took a point that is not finite";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("2"), std::string::npos) << error.what();
  }
}

TEST(PlanarHeldOut, PrefersTheMapOfItsPlace) {  // -ln(2 pi s^2) at the mean of a round Gaussian
  MapScale<2> scale;
  scale.keys = {{0, 0}};
  scale.gaussians = {{{0, 0}, 0.01 * Matrix<2>::Identity(), 50.0}};
  const GaussianMap<2> map({1.0, 10, 1, 0.01}, {scale});
  const double at_mean = -std::log(2.0 * M_PI * 0.01);
  EXPECT_NEAR(heldOutLogLikelihood<2>(map, 0, {{0.5, 0.5}}).mean_inside, at_mean, 1e-12);
  EXPECT_NEAR(heldOutLogLikelihood<2>(map, {{0.5, 0.5}}).mean_inside, at_mean, 1e-12);
  EXPECT_NEAR(heldOutLogLikelihood<2>(map, 0, {{0.6, 0.5}}).mean_inside, at_mean - 0.5, 1e-12);  // one sigma
  EXPECT_EQ(heldOutLogLikelihood<2>(map, 0, {{0.5, 0.5}, {9, 9}}).nowhere, 1u);
}

}  // namespace
}  // namespace gaussmap
