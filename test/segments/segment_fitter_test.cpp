// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/segment_fitter.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "segments/scan_makers.h"

namespace gaussmap {
namespace {

using test::look;
using test::room;
using test::wall;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A way round the middle of a room.
SegmentFitter mapOf(const std::vector<Segment>& walls, int scans, double noise,
                    const SegmentFitterOptions& options = {}, std::shared_ptr<SegmentUtility> utility = {}) {
  Random random(7);
  SegmentFitter fitter(options, std::move(utility));
  for (int i = 0; i < scans; ++i)
    fitter.add(look(walls, 0.5 * std::cos(0.7 * i), 0.5 * std::sin(0.7 * i), 0.3 * i, noise, random));
  return fitter;
}

double distanceToMap(const SegmentMap& map, const Vector<2>& point) {
  double least = kInfinity;
  for (const Segment& segment : map.segments) least = std::min(least, segment.distance(point));
  return least;
}

void expectSame(const SegmentMap& a, const SegmentMap& b) {
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    EXPECT_EQ(a.segments[i].start, b.segments[i].start);
    EXPECT_EQ(a.segments[i].end, b.segments[i].end);
    EXPECT_EQ(a.segments[i].covariance, b.segments[i].covariance);
  }
}

TEST(SegmentFitter, ARoomIsFourSegmentsInAClosedChain) {
  const std::vector<Segment> walls = room(-3.0, -2.0, 4.0, 3.0);
  for (const bool refine : {false, true}) {
    SegmentFitterOptions options;
    options.optimise = refine;
    const SegmentMap map = mapOf(walls, 40, 0.02, options).map();
    ASSERT_EQ(map.segments.size(), 4u);
    ASSERT_EQ(map.chains.size(), 1u);
    EXPECT_TRUE(map.chains[0].closed);
    for (std::size_t i = 0; i < 4; ++i) {
      const Segment &segment = map.segments[i], &next = map.segments[(i + 1) % 4];
      EXPECT_EQ(segment.end, next.start);
      double nearest = kInfinity;
      for (const Segment& true_wall : walls) {
        if (true_wall.direction().dot(segment.direction()) < 0.9) continue;
        nearest = std::min(nearest, (true_wall.start - segment.start).norm() + (true_wall.end - segment.end).norm());
      }
      EXPECT_LT(nearest, 0.02);
      EXPECT_EQ(segment.last_seen, 39);
      EXPECT_NEAR(std::sqrt(segment.normal_variance), 0.02 * std::sqrt(2.0), 0.012);  // noise and its model
    }
  }
}

TEST(SegmentFitter, TheFacesOfAThinWallAreTwoSegmentsThatLookAway) {
  // A wall 12 cm thick between two rooms, seen from both.
  std::vector<Segment> walls = room(-4.0, -2.0, 0.0, 2.0), other = room(0.12, -2.5, 4.0, 2.5);
  walls.insert(walls.end(), other.begin(), other.end());
  Random random(3);
  SegmentFitter fitter;
  for (int i = 0; i < 30; ++i) {
    fitter.add(look(walls, -2.0 + 0.02 * i, 0.1 * (i % 5), 0.1 * i, 0.02, random));
    fitter.add(look(walls, 2.0 + 0.02 * i, 0.1 * (i % 5), 0.1 * i, 0.02, random));
  }
  const SegmentMap map = fitter.map();
  EXPECT_EQ(map.segments.size(), 8u);
  int left = 0, right = 0;
  for (const Segment& segment : map.segments) {
    if (std::abs(segment.start.x() - segment.end.x()) > 0.1) continue;
    if (std::abs(segment.start.x()) < 0.01) left += segment.normal().x() < -0.99;
    if (std::abs(segment.start.x() - 0.12) < 0.01) right += segment.normal().x() > 0.99;
  }
  EXPECT_EQ(left, 1);
  EXPECT_EQ(right, 1);
}

TEST(SegmentFitter, ADoorStaysOpen) {
  std::vector<Segment> walls = room(-3.0, -2.0, 3.0, 5.0);
  walls.push_back(wall(3.0, 2.0, 0.45, 2.0));  // a wall with a door of 90 cm, the far room behind
  walls.push_back(wall(-0.45, 2.0, -3.0, 2.0));
  const SegmentMap map = mapOf(walls, 40, 0.02).map();
  EXPECT_GT(distanceToMap(map, {0.0, 2.0}), 0.4);
  EXPECT_LT(distanceToMap(map, {1.0, 2.0}), 0.02);
  EXPECT_LT(distanceToMap(map, {-0.5, 2.0}), 0.03);
  EXPECT_LT(distanceToMap(map, {0.0, 5.0}), 0.02);
}

TEST(SegmentFitter, WhatManyRaysCrossIsPruned) {
  Random random(4);
  const std::vector<Segment> empty = room(-3.0, -2.0, 4.0, 3.0);
  std::vector<Segment> with_box = empty;
  for (const Segment& side : {wall(1.5, 0.3, 1.5, -0.3), wall(2.0, -0.3, 2.0, 0.3), wall(2.0, 0.3, 1.5, 0.3)})
    with_box.push_back(side);
  for (const bool prune : {true, false}) {
    SegmentFitterOptions options;
    options.prune = prune;
    options.optimise = false;
    SegmentFitter fitter(options);
    std::size_t pruned = 0;
    for (int i = 0; i < 40; ++i)
      pruned += fitter.add(look(i < 3 ? with_box : empty, 0.02 * i, 0.0, 0.1 * i, 0.02, random)).pruned;
    EXPECT_EQ(distanceToMap(fitter.map(), {1.5, 0.0}) > 1.0, prune);
    EXPECT_EQ(pruned > 0, prune);
  }
}

TEST(SegmentFitter, IsAsExactFarFromTheOrigin) {
  const std::vector<Segment> walls = room(-3.0, -2.0, 4.0, 3.0);
  Random near_random(1), far_random(1);
  SegmentFitter near, far;
  const Vector<2> away(1e7, -1e7);
  for (int i = 0; i < 20; ++i) {
    near.add(look(walls, 0.02 * i, 0.1, 0.2 * i, 0.02, near_random));
    LaserScan scan = look(walls, 0.02 * i, 0.1, 0.2 * i, 0.02, far_random);
    scan.pose.translation += away;
    far.add(scan);
  }
  const SegmentMap a = near.map(), b = far.map();
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    EXPECT_NEAR((a.segments[i].start + away - b.segments[i].start).norm(), 0.0, 1e-6);
    EXPECT_NEAR(a.segments[i].normal_variance, b.segments[i].normal_variance, 1e-9);
  }
}

TEST(SegmentFitter, TheSameScansGiveTheSameMap) {
  const std::vector<Segment> walls = room(-3.0, -2.0, 4.0, 3.0);
  for (const EvidencePolicy policy : {EvidencePolicy::MomentCells, EvidencePolicy::ParticleSets}) {
    SegmentFitterOptions options;
    options.policy = policy;
    const SegmentFitter fitter = mapOf(walls, 10, 0.02, options);
    expectSame(mapOf(walls, 10, 0.02, options).map(), fitter.map());
    expectSame(fitter.map(), fitter.map());
    options.particles.seed = 9;
    const SegmentMap other = mapOf(walls, 10, 0.02, options).map();
    EXPECT_EQ(other.segments[0].start == fitter.map().segments[0].start, policy == EvidencePolicy::MomentCells);
  }
}

TEST(SegmentFitter, ParticlesGiveTheSameRoom) {
  const std::vector<Segment> walls = room(-3.0, -2.0, 4.0, 3.0);
  SegmentFitterOptions options;
  options.policy = EvidencePolicy::ParticleSets;
  const SegmentFitter fitter = mapOf(walls, 20, 0.02, options);
  const SegmentMap map = fitter.map();
  ASSERT_EQ(map.segments.size(), 4u);
  for (const Segment& segment : map.segments) {
    double nearest = kInfinity;
    for (const Segment& true_wall : walls) nearest = std::min(nearest, (true_wall.start - segment.start).norm());
    EXPECT_LT(nearest, 0.03);
  }
  const double bound = 300.0 * (24.0 + 12 * 0.25);  // a metre, and a bin or two at each end of a wall
  EXPECT_LT(static_cast<double>(fitter.evidence().size()), bound);
  EXPECT_GT(static_cast<double>(fitter.evidence().size()), 0.5 * bound);
}

TEST(SegmentFitter, ThePresetIsThePaperAsPrinted) {
  const SegmentFitterOptions options = SegmentFitterOptions::leal2000();
  EXPECT_EQ(options.policy, EvidencePolicy::ParticleSets);
  EXPECT_EQ(options.particles.limit, ParticleLimit::Segment);
  EXPECT_FALSE(options.prune);
  EXPECT_FALSE(options.optimise);
  const std::vector<Segment> walls = room(-3.0, -2.0, 4.0, 3.0);
  const SegmentFitter fitter = mapOf(walls, 20, 0.02, options, std::make_shared<ViewpointInvariantUtility>());
  EXPECT_EQ(fitter.map().segments.size(), 4u);
  EXPECT_LE(static_cast<double>(fitter.evidence().size()), 300.0 * 24.0 * 1.05);  // 300 per metre of wall
}

TEST(SegmentFitter, MemoryGrowsWithTheMapNotWithTheScans) {
  const std::vector<Segment> walls = room(-3.0, -2.0, 4.0, 3.0);
  EXPECT_LT(mapOf(walls, 400, 0.02).memoryBytes(), 2 * mapOf(walls, 100, 0.02).memoryBytes());
}

TEST(SegmentFitter, ALongerMinimumLengthMakesACoarserMap) {
  // A round column of 36 sides, 2 m across, in a room.
  std::vector<Segment> walls = room(-3.0, -3.0, 5.0, 3.0);
  for (int i = 0; i < 36; ++i) {
    const auto corner = [](int k) {
      const double angle = -2.0 * std::acos(-1.0) * k / 36.0;
      return Vector<2>(2.5 + std::cos(angle), std::sin(angle));
    };
    const Vector<2> a = corner(i), b = corner(i + 1);
    walls.push_back(wall(a.x(), a.y(), b.x(), b.y()));
  }
  std::vector<double> variances;
  std::vector<std::size_t> counts;
  for (const double length : {0.4, 1.0, 3.0}) {
    ViewpointInvariantOptions options;
    options.min_length = length;
    options.sigma_threshold = 0.015;
    const auto utility = std::make_shared<ViewpointInvariantUtility>(options);
    Random random(1);
    SegmentFitterOptions fitting;
    fitting.noise = {0.003, 5e-4};
    SegmentFitter fitter(fitting, utility);
    SegmentStatistics last;
    for (int i = 0; i < 20; ++i) last = fitter.add(look(walls, -1.0, 0.1 * i - 1.0, 0.0, 0.003, random));
    EXPECT_EQ(last.segments, fitter.map().segments.size());
    EXPECT_GT(last.coverage, 0.7);
    variances.push_back(last.normal_variance);
    counts.push_back(last.segments);
  }
  EXPECT_LT(variances[0], variances[1]);
  EXPECT_LT(variances[1], variances[2]);
  EXPECT_GT(counts[0], counts[1]);
  EXPECT_GE(counts[1], counts[2]);
}

TEST(SegmentFitter, DetailNearTheObserverIsGivenUpBehindIt) {
  // A corridor of 40 m, a step of 25 cm in the wall every 80 cm.
  std::vector<Segment> walls = {wall(-2.0, -1.0, 40.0, -1.0), wall(40.0, -1.0, 40.0, 1.5), wall(-2.0, 1.5, -2.0, -1.0)};
  for (double x = 40.0; x > -2.0; x -= 1.6) {
    walls.push_back(wall(x, 1.5, x - 0.8, 1.5));
    walls.push_back(wall(x - 0.8, 1.5, x - 0.8, 1.25));
    walls.push_back(wall(x - 0.8, 1.25, x - 1.6, 1.25));
    walls.push_back(wall(x - 1.6, 1.25, x - 1.6, 1.5));
  }
  ViewpointDependentOptions view;
  view.far = {0.04, 3.0, 0.5};
  view.radius = 4.0;
  view.scale = 0.2;
  SegmentFitter fitter({}, std::make_shared<ViewpointDependentUtility>(view));
  const auto near = [&](double x) {
    std::size_t count = 0;
    for (const Segment& segment : fitter.map().segments)
      count += std::abs(0.5 * (segment.start.x() + segment.end.x()) - x) < 2.0 && segment.start.y() > 1.0;
    return count;
  };
  Random random(1);
  std::size_t while_there = 0;
  for (int i = 0; i <= 60; ++i) {
    fitter.add(look(walls, 5.0 + 0.4 * i, 0.0, 0.0, 0.005, random));
    if (i == 10) while_there = near(8.0);
  }
  EXPECT_GT(while_there, near(8.0));
  EXPECT_GE(near(28.0), near(8.0) + 2);
}

TEST(SegmentFitter, AUserDefinedUtilityDecides) {
  const std::vector<Segment> walls = room(-3.0, -2.0, 4.0, 3.0);
  const auto never = std::make_shared<UserUtility>();
  never->nothing_vote = [](const SegmentGoals&) { return 0.0; };
  SegmentFitterOptions options;
  const SegmentFitter fitter = mapOf(walls, 1, 0.0, options, never);
  EXPECT_EQ(fitter.map().segments.size(), 1u);  // one scan, one run, nothing split
  const auto fine = std::make_shared<UserUtility>();
  fine->nothing_vote = [](const SegmentGoals&) { return 0.5; };
  fine->split_vote = [](const SegmentGoals& whole, const SegmentGoals&, const SegmentGoals&) { return whole.length; };
  for (const Segment& segment : mapOf(walls, 1, 0.0, options, fine).map().segments) EXPECT_LE(segment.length(), 0.7);
}

TEST(SegmentFitter, StatisticsAddUp) {
  const std::vector<Segment> walls = room(-3.0, -2.0, 4.0, 3.0);
  Random random(1);
  SegmentFitter fitter;
  std::size_t balance = 0;
  for (int i = 0; i < 20; ++i) {
    const SegmentStatistics s = fitter.add(look(walls, 0.0, 0.1 * i, 0.0, 0.02, random));
    balance += s.created + s.splits - s.merges - s.pruned;
    EXPECT_EQ(s.beams, 360u);
    EXPECT_EQ(s.segments, balance);
    EXPECT_GT(s.coverage, 0.99);
    if (i == 0) {
      EXPECT_EQ(s.associated, 0u);
    } else {
      EXPECT_GT(s.associated, 330u);
    }
  }
  EXPECT_EQ(fitter.scans(), 20u);
}

void expectSound(const SegmentFitter& fitter) {
  for (const Segment& segment : fitter.map().segments) {
    EXPECT_TRUE(segment.start.allFinite() && segment.end.allFinite());
    EXPECT_TRUE(segment.covariance.allFinite());
    EXPECT_GT(segment.covariance.determinant(), 0.0);
    EXPECT_GE(segment.normal_variance, 0.0);
    EXPECT_GT(segment.weight, 0.0);
  }
}

TEST(SegmentFitter, DegenerateScansDoNoHarm) {
  for (const EvidencePolicy policy : {EvidencePolicy::MomentCells, EvidencePolicy::ParticleSets}) {
    SegmentFitterOptions options;
    options.policy = policy;
    options.particles.limit = ParticleLimit::Segment;
    SegmentFitter fitter(options);
    EXPECT_TRUE(fitter.map().segments.empty());
    LaserScan scan;
    fitter.add(scan);  // no beams
    for (int i = 0; i < 90; ++i) scan.bearings.push_back(0.02 * i);
    scan.ranges.assign(90, kInfinity);
    EXPECT_EQ(fitter.add(scan).beams, 0u);
    EXPECT_TRUE(fitter.map().segments.empty());
    scan.ranges.assign(90, 0.0);
    fitter.add(scan);
    scan.ranges.assign(90, std::nan(""));
    scan.ranges[40] = 2.0;
    EXPECT_EQ(fitter.add(scan).beams, 1u);
    EXPECT_EQ(fitter.map().segments.size(), 1u);
    expectSound(fitter);
    scan.ranges.assign(90, 3.0);  // all equal: an arc
    for (int i = 0; i < 3; ++i) fitter.add(scan);
    scan.ranges.assign(90, 1e-300);  // at the sensor
    fitter.add(scan);
    scan.bearings.assign(90, 0.5);  // all in one place
    scan.ranges.assign(90, 4.0);
    for (int i = 0; i < 3; ++i) fitter.add(scan);
    for (int i = 0; i < 90; ++i) scan.ranges[i] = 4.0 + 0.05 * i;  // along the line of sight
    for (int i = 0; i < 3; ++i) fitter.add(scan);
    expectSound(fitter);
    Random random(1);
    for (int i = 0; i < 20; ++i) {  // nonsense
      LaserScan noise;
      for (int k = 0; k < 60; ++k) {
        noise.bearings.push_back(0.1 * k - 3.0);
        noise.ranges.push_back(random.uniform() < 0.2 ? kInfinity : 70.0 * std::pow(random.uniform(), 4));
      }
      noise.pose.translation = {5.0 * random.normal(), 5.0 * random.normal()};
      noise.pose.heading = 100.0 * random.normal();
      fitter.add(noise);
    }
    expectSound(fitter);
  }
}

TEST(SegmentFitter, RefusesScansThatAreNoneAndCountsThemNot) {
  Random random(1);
  const LaserScan good = look(room(-3.0, -2.0, 4.0, 3.0), 0.0, 0.0, 0.0, 0.02, random);
  SegmentFitter fitter, other;
  fitter.add(good);
  other.add(good);
  LaserScan bad = good;
  bad.pose.translation.x() = std::nan("");
  EXPECT_THROW(fitter.add(bad), std::invalid_argument);
  bad = good;
  bad.pose.heading = kInfinity;
  EXPECT_THROW(fitter.add(bad), std::invalid_argument);
  bad = good;
  bad.bearings.pop_back();
  EXPECT_THROW(fitter.add(bad), std::invalid_argument);
  bad = good;
  bad.bearings[7] = std::nan("");
  EXPECT_THROW(fitter.add(bad), std::invalid_argument);
  bad = good;
  std::swap(bad.bearings[3], bad.bearings[9]);
  EXPECT_THROW(fitter.add(bad), std::invalid_argument);
  bad = good;
  bad.pose.covariance(0, 0) = -1.0;
  EXPECT_THROW(fitter.add(bad), std::invalid_argument);
  EXPECT_EQ(fitter.scans(), 1u);
  expectSame(fitter.map(), other.map());
}

TEST(SegmentFitter, RefusesUnusableOptions) {
  const auto refused = [](auto change) {
    SegmentFitterOptions options;
    change(options);
    EXPECT_THROW(SegmentFitter{options}, std::invalid_argument);
  };
  refused([](SegmentFitterOptions& options) { options.cell = 0.0; });
  refused([](SegmentFitterOptions& options) { options.gap = std::nan(""); });
  refused([](SegmentFitterOptions& options) { options.growth = -1.0; });
  refused([](SegmentFitterOptions& options) { options.noise.range = -1.0; });
  refused([](SegmentFitterOptions& options) { options.particles.samples = 0; });
  refused([](SegmentFitterOptions& options) { options.particles.per_metre = 0.0; });
  refused([](SegmentFitterOptions& options) { options.optimisation.segment_cost = -1.0; });
  refused([](SegmentFitterOptions& options) { options.optimisation.tolerance = 0.0; });
}

TEST(SegmentFitter, SaysWhatIsRequiredOfAnOption) {
  const auto messageFor = [](auto change) -> std::string {
    SegmentFitterOptions options;
    change(options);
    try {
      SegmentFitter{options};
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(messageFor([](SegmentFitterOptions& options) { options.cell = -1.0; }), "cell = -1: must be positive");
  EXPECT_EQ(messageFor([](SegmentFitterOptions& options) { options.growth = -1e-9; }),
            "growth = -1e-09: must not be negative");
  EXPECT_EQ(messageFor([](SegmentFitterOptions& options) { options.particles.samples = 0; }),
            "particles.samples = 0: must be at least 1");
  EXPECT_EQ(messageFor([](SegmentFitterOptions& options) { options.noise.range = std::nan(""); }),
            "range noise = nan: must be finite and not negative");
}

}  // namespace
}  // namespace gaussmap
