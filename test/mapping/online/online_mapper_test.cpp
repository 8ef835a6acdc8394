// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/online/online_mapper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "gaussmap/evaluation/hausdorff.h"
#include "mapping/online/online_scenes.h"

namespace gaussmap {
namespace {

using namespace test;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(OnlineMapper, GivesTheFinestScaleOfTheBatchMapToTheLastBitUnderTheExactPolicy) {
  const std::vector<Scan> scans = hallScans(5);
  OnlineOptions options;
  options.map = {0.2, 5, 3, 0.0};
  options.forget = false;
  OnlineMapper<3> mapper(options);
  MomentGrid<3> all(0.2);
  for (const Scan& scan : scans) {
    mapper.add(scan);
    all.addPoints(inMap(scan));
  }
  const GaussianMap<3> online = mapper.map(), batch = build<3>(all, options.map);
  EXPECT_EQ(online.scale(0).keys, batch.scale(0).keys);
  EXPECT_EQ(online.scale(0).moments, batch.scale(0).moments);
  EXPECT_TRUE(online.acceptsScans());
}

TEST(OnlineMapper, GivesTheCoarseScalesOfTheBatchMapWhileNothingIsRefined) {
  OnlineOptions options = wallOptions();
  OnlineMapper<3> mapper(options);
  MomentGrid<3> all(0.2);
  for (const bool with_box : {true, true, true}) {
    mapper.add(wallScan(with_box));
    all.addPoints(inMap(wallScan(with_box)));
  }
  const GaussianMap<3> online = mapper.map(), batch = build<3>(all, options.map);
  for (int s = 1; s < 3; ++s) {
    ASSERT_EQ(online.scale(s).keys, batch.scale(s).keys);
    for (std::size_t i = 0; i < online.gaussianCount(s); ++i) {
      const Gaussian<3> a = online.localGaussian(i, s), b = batch.localGaussian(i, s);
      EXPECT_LT((a.mean - b.mean).norm(), 1e-9);
      EXPECT_LT((a.cov - b.cov).norm(), 1e-9);
      EXPECT_DOUBLE_EQ(a.weight, b.weight);
    }
  }
}

TEST(OnlineMapper, HoldsEveryPointAtEveryScaleAndNeverMoreGaussiansThanTheBudget) {
  OnlineOptions options;
  options.map = {0.2, 5, 3, 0.0};
  options.forget = false;
  options.refine_every = 1;
  options.refine_cells = 300;
  options.budget = 2.0;
  OnlineMapper<3> mapper(options);
  std::size_t points = 0, added = 0;
  for (const Scan& scan : hallScans(6)) {
    const OnlineStatistics statistics = mapper.add(scan);
    points += static_cast<std::size_t>(statistics.points.accepted);
    added += statistics.added;
    const GaussianMap<3> map = mapper.map();
    for (int s = 0; s < 3; ++s) EXPECT_NEAR(map.weight(s), double(points), 1e-6) << s;
    for (int s = 1; s < 3; ++s) EXPECT_LE(map.gaussianCount(s), 2 * map.cellCount(s));
  }
  EXPECT_GT(added, 500u);
  // Exact: a coarse cluster is the moment match of what is linked to it.
  const GaussianMap<3> map = mapper.map();
  for (std::size_t i = 0; i < map.gaussianCount(1); ++i) {
    double weight = 0.0;
    for (const std::size_t child : map.childrenOf(i, 1)) weight += map.localGaussian(child, 0).weight;
    EXPECT_NEAR(map.localGaussian(i, 1).weight, weight, 1e-9);
  }
}

TEST(OnlineMapper, EndsAsNearToThePointsAsTheBatchMapOfTheSameSize) {
  OnlineOptions options;
  options.map = {0.2, 10, 3, 0.0};
  options.forget = false;
  options.refine_every = 1;
  OnlineMapper<3> mapper(options);
  std::vector<Vector<3>> points;
  MomentGrid<3> all(0.2);
  for (const Scan& scan : hallScans(10)) {
    mapper.add(scan);
    for (const Vector<3>& point : inMap(scan)) points.push_back(point);
  }
  all.addPoints(points);
  const GaussianMap<3> online = mapper.map();
  MaxGaussians same_size;
  for (int s = 1; s < 3; ++s) same_size.by_scale[s] = online.gaussianCount(s);
  const GaussianMap<3> batch = refine(build<3>(all, options.map), same_size).map;
  const Reference truth(points);
  for (int s = 1; s < 3; ++s) {
    EXPECT_EQ(online.gaussianCount(s), batch.gaussianCount(s));
    SampleOptions samples;
    samples.samples = 20000;
    const DistanceSummary ours = truth.compare(online, s, samples).all.forward;
    const DistanceSummary theirs = truth.compare(batch, s, samples).all.forward;
    EXPECT_LE(ours.q95, 1.05 * theirs.q95) << "scale " << s;
    EXPECT_LE(ours.mean, 1.05 * theirs.mean) << "scale " << s;
  }
}

TEST(OnlineMapper, GivesTheSameBytesForOneAndTwoThreads) {
  for (const LearningRate rate : {LearningRate::SampleMean, LearningRate::Occupancy})
    for (const RefineMethod method : {RefineMethod::Agglomerate, RefineMethod::Insert}) {
      OnlineOptions options;
      options.map = {0.2, 5, 3, 0.0};
      options.learning_rate = rate;
      options.method = method;
      options.refine_every = 2;
      options.refine_cells = 50;
      options.threads = 1;
      OnlineMapper<3> one(options);
      options.threads = 2;
      OnlineMapper<3> two(options);
      for (const Scan& scan : hallScans(4)) {
        one.add(scan);
        two.add(scan);
      }
      EXPECT_TRUE(sameMap(one.map(), two.map()));
    }
}

TEST(OnlineMapper, LearnsByTheRateOfEquationFive) {
  OnlineOptions options = wallOptions();
  options.learning_rate = LearningRate::Occupancy;
  OnlineMapper<3> mapper(options);
  Scan scan;
  scan.points = {{1.1, 0.1, 0.1}};
  mapper.add(scan);
  scan.points = {{1.16, 0.1, 0.1}};
  mapper.add(scan);
  // After the first scan the log-odds are 0.85. The first point is counted with the rate of log-odds 0, but moves
  // nothing: the cell began at it.
  const double rate = (5e-4 - 5e-2) / 20.0 * (0.85 + 10.0) + 5e-2;
  const Gaussian<3> learnt = mapper.map().gaussian(0, 0);
  EXPECT_NEAR(learnt.mean.x(), 1.1 + rate * 0.06, 1e-9);
  const double off = 0.06 * (1.0 - rate), noise = 0.01;
  EXPECT_NEAR(learnt.cov(0, 0), noise * noise + rate * off * off, 1e-9);
  EXPECT_NEAR(learnt.cov(1, 1), noise * noise, 1e-15);
  EXPECT_DOUBLE_EQ(learnt.weight, 2.0);
  EXPECT_FALSE(mapper.map().acceptsScans());
}

TEST(OnlineMapper, TakesScansWithoutPoints) {
  OnlineMapper<3> mapper(wallOptions());
  EXPECT_EQ(mapper.add({}).points.accepted, 0);
  EXPECT_TRUE(mapper.map().empty());
  Scan scan;
  scan.points = {{kNaN, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, INFINITY, 0.0}};
  EXPECT_EQ(mapper.add(scan).points.accepted, 0);
  EXPECT_TRUE(mapper.map().empty());
  scan.points.push_back({3.0, 0.1, 0.1});
  EXPECT_EQ(mapper.add(scan).points.accepted, 1);
  EXPECT_EQ(mapper.map().gaussianCount(0), 1u);
  EXPECT_EQ(mapper.scans(), 3u);
}

TEST(OnlineMapper, TakesAScanFromInsideAWall) {
  OnlineMapper<3> mapper(wallOptions());
  mapper.add(wallScan(false));
  const std::size_t before = mapper.map().gaussianCount(0);
  Scan inside = wallScan(false);
  inside.pose.translation.x() = 10.1;  // of a map that says otherwise
  mapper.add(inside);
  EXPECT_GE(mapper.map().gaussianCount(0), before);
}

TEST(OnlineMapper, LeavesTheMapAloneWhenAPointIsTooFarAway) {
  for (const LearningRate rate : {LearningRate::SampleMean, LearningRate::Occupancy}) {
    OnlineOptions options = wallOptions();
    options.learning_rate = rate;
    OnlineMapper<3> mapper(options);
    mapper.add(wallScan(true));
    const GaussianMap<3> before = mapper.map();
    Scan far = wallScan(false);
    far.points.push_back({1e12, 0.0, 0.0});
    EXPECT_THROW(mapper.add(far), std::out_of_range);
    EXPECT_EQ(mapper.scans(), 1u);
    EXPECT_TRUE(sameMap(mapper.map(), before));
  }
}

TEST(OnlineMapper, MapsFarFromTheOriginAsAtIt) {
  OnlineMapper<3> near(wallOptions()), far(wallOptions());
  for (int i = 0; i < 7; ++i) {
    Scan scan = wallScan(i < 2);
    near.add(scan);
    scan.pose.translation = {2e6 * 5.0, -1e6 * 5.0, 0.0};  // whole coarsest cells
    far.add(scan);
  }
  EXPECT_EQ(near.map().gaussianCount(0), far.map().gaussianCount(0));
  EXPECT_NEAR(near.map().weight(0), far.map().weight(0), 0.01 * near.map().weight(0));
}

TEST(OnlineMapper, MapsInThePlaneToo) {
  const Simulation plan = makeSimulation(WorldName::Plan, {6, false});
  OnlineOptions options;
  options.map = {0.05, 10, 3, 0.0};
  options.forget = false;
  OnlineMapper<2> mapper(options);
  MomentGrid<2> all(0.05);
  for (std::size_t i = 0; i < 6; ++i) {
    const Scan scan = asScan(simulateScan(plan, i));
    const OnlineStatistics statistics = mapper.add(scan);
    EXPECT_GT(statistics.cells_tested, 0u);
    std::vector<Vector<2>> points;
    for (const Vector<3>& point : inMap(scan)) points.push_back(point.head<2>());
    all.addPoints(points);
  }
  const GaussianMapQuadtree map = mapper.map(), batch = build<2>(all, options.map);
  EXPECT_EQ(map.scale(0).keys, batch.scale(0).keys);
  EXPECT_EQ(map.scale(0).moments, batch.scale(0).moments);
}

TEST(OnlineMapper, RunsTheSystemOfThePaper) {
  OnlineOptions options = OnlineOptions::yguel2009(3);
  EXPECT_EQ(options.map.resolution, 0.1);
  EXPECT_EQ(options.occupancy_every, 3);
  EXPECT_EQ(OnlineOptions::yguel2009(2).map.resolution, 0.05);
  EXPECT_EQ(OnlineOptions::yguel2009(2).occupancy_every, 1);
  EXPECT_THROW(OnlineOptions::yguel2009(4), std::invalid_argument);
  options.map.resolution = 0.2;  // faster
  OnlineMapper<3> mapper(options);
  std::size_t added = 0;
  for (const Scan& scan : hallScans(10)) {
    added = mapper.add(scan).added;
    EXPECT_EQ(added > 0, mapper.scans() == 10);
  }
  EXPECT_LE(added, 8u);  // four clusters for each of the two coarse scales
  const GaussianMap<3> map = mapper.map();
  EXPECT_FALSE(map.acceptsScans());
  EXPECT_EQ(map.gaussianCount(1) + map.gaussianCount(2), map.cellCount(1) + map.cellCount(2) + added);
}

TEST(OnlineMapper, RefusesOptionsThatMeanNothing) {
  const auto with = [](auto change) {
    OnlineOptions options;
    change(options);
    return OnlineMapper<3>(options);
  };
  EXPECT_THROW(with([](auto& o) { o.map.resolution = -1.0; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.occupancy.hit = 0.0; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.occupancy.miss = kNaN; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.occupancy_every = 0; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.look_back = -1; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.budget = 0.5; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.fastest_rate = 1e-5; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.reach = -1.0; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.link = 1e9; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.visibility.clearance = kNaN; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.no_return_is_free = -1.0; }), std::invalid_argument);
  EXPECT_THROW(with([](auto& o) { o.projection = PlanarProjection{}; }), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
