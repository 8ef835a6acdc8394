// SPDX-License-Identifier: BSD-3-Clause
// Each setting of SegmentFitterOptions::leal2000() changes the map: these tests fail if the setting is lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/evidence.h"
#include "segments/scan_makers.h"

namespace gaussmap {
namespace {

using Change = std::function<void(SegmentFitterOptions&)>;

/// Returns the exact scan of these points, in the order of their bearings.
LaserScan lookAt(std::vector<Vector<2>> points, const Vector<2>& sensor) {
  const auto bearing = [&](const Vector<2>& p) { return std::atan2(p.y() - sensor.y(), p.x() - sensor.x()); };
  std::sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return bearing(a) < bearing(b); });
  LaserScan scan;
  scan.pose.translation = sensor;
  for (const Vector<2>& point : points) {
    scan.bearings.push_back(bearing(point));
    scan.ranges.push_back((point - sensor).norm());
  }
  return scan;
}

/// Returns points every 5 cm along the line y = `y`, from x0 to x1.
std::vector<Vector<2>> line(double x0, double x1, double y) {
  std::vector<Vector<2>> points;
  for (int i = 0; x0 + 0.05 * i <= x1; ++i) points.emplace_back(x0 + 0.05 * i, y);
  return points;
}

/// A fitter of the paper, with eq. (4).
SegmentFitter asPrinted(const Change& change = {}, double sigma = 0.06) {
  SegmentFitterOptions options = SegmentFitterOptions::leal2000();
  options.noise = {0.01, 1e-3};
  if (change) change(options);
  ViewpointInvariantOptions utility;
  utility.sigma_threshold = sigma;
  return SegmentFitter(options, std::make_shared<ViewpointInvariantUtility>(utility));
}

// Scans of a wall from below. The bearings of these points are not evenly spaced, so runs of beams would end where the
// step grows; looking from far away keeps the steps nearly equal.
const Vector<2> kBelow(2.0, -6.0), kAbove(2.0, 6.0);

std::size_t evidenceWithin(const SegmentFitter& fitter, double x0, double x1) {
  const std::vector<Vector<2>> points = fitter.evidence();
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [&](const auto& p) { return p.x() >= x0 && p.x() < x1; }));
}

TEST(Leal2000, AnObservationIsThirtyParticles) {
  SegmentFitter fitter = asPrinted();
  fitter.add(lookAt({{2.0, 0.0}}, kBelow));
  EXPECT_EQ(fitter.evidence().size(), 30u);
  SegmentFitter moments = asPrinted([](auto& options) { options.policy = EvidencePolicy::MomentCells; });
  moments.add(lookAt({{2.0, 0.0}}, kBelow));
  EXPECT_EQ(moments.evidence().size(), 1u);
}

TEST(Leal2000, AMetreHasAtMost300ParticlesAndPartsThatAreNotSeenLoseThem) {
  const auto lookAtOneHalf = [](const Change& change) {
    SegmentFitter fitter = asPrinted(change);
    fitter.add(lookAt(line(0.0, 4.0, 0.0), kBelow));
    for (int scan = 0; scan < 60; ++scan) fitter.add(lookAt(line(2.0, 4.0, 0.0), kBelow));
    return fitter;
  };
  const SegmentFitter fitter = lookAtOneHalf({});
  EXPECT_LE(fitter.evidence().size(), 1230u);  // the noise makes the wall a little longer than 4 m
  EXPECT_GT(fitter.evidence().size(), 550u);   // 300 per metre of the half that is still known
  EXPECT_LE(evidenceWithin(fitter, 0.0, 1.9), 5u);
  const SegmentFitter bins = lookAtOneHalf([](auto& options) { options.particles.limit = ParticleLimit::Bins; });
  EXPECT_GT(evidenceWithin(bins, 0.0, 1.9), 450u);
}

TEST(Leal2000, ANewSegmentKeepsTheParticlesOfItsWholeLength) {
  SegmentFitter fitter = asPrinted();
  fitter.add(lookAt(line(0.0, 2.0, 0.0), kBelow));  // 41 beams, 30 particles each, 2 m
  EXPECT_GE(fitter.evidence().size(), 590u);
  EXPECT_LE(fitter.evidence().size(), 630u);
}

TEST(Leal2000, TheParticlesOfALongSegmentAreBoundedByLMin) {
  const auto particles = [](double factor) {
    SegmentFitterOptions options = SegmentFitterOptions::leal2000();
    options.min_length *= factor;
    const auto keeper = detail::makeEvidenceKeeper(options);
    detail::SegmentEvidence evidence;
    const std::vector<ObservationPoint> observation(30, ObservationPoint{Vector<2>(0.0, 0.0), 1.0 / 30.0});
    for (std::uint64_t i = 0; i < 1000; ++i) keeper->add(observation, 50.0, i, evidence);
    return evidence.particles.size();
  };
  EXPECT_EQ(particles(1.0), 3000u);  // 300 per metre of 10 l_min
  EXPECT_EQ(particles(2.0), 6000u);
}

TEST(Leal2000, AnObservationReplacesMPriorParticlesAndIsKeptWhole) {
  SegmentFitterOptions options = SegmentFitterOptions::leal2000();
  options.particles.per_metre = 60.0;
  const auto keeper = detail::makeEvidenceKeeper(options);
  const auto observationAt = [](double x) {
    return std::vector<ObservationPoint>(30, ObservationPoint{Vector<2>(x, 0.0), 1.0 / 30.0});
  };
  double previous = 0.0;
  constexpr int kObservations = 2000;
  detail::SegmentEvidence evidence;
  for (int i = 0; i < kObservations; ++i) {
    const double x = 0.001 * i;
    keeper->add(observationAt(x), 1.0, static_cast<std::uint64_t>(i), evidence);
    ASSERT_LE(evidence.particles.size(), 60u);
    const auto countAt = [&](double place) {
      return std::count_if(evidence.particles.begin(), evidence.particles.end(),
                           [&](const auto& p) { return std::abs(static_cast<double>(p.x()) - place) < 1e-4; });
    };
    ASSERT_EQ(countAt(x), 30);
    if (i > 1) previous += static_cast<double>(countAt(x - 0.001));
  }
  // Of 60 particles, 30 random ones are deleted: half of the previous observation. Standard error .06.
  EXPECT_NEAR(previous / (kObservations - 2), 15.0, 0.3);
}

TEST(Leal2000, AssociationTestsOnlyThePolygonSoBothFacesAreOneSegment) {
  const auto associated = [](const Change& change) {
    SegmentFitter fitter = asPrinted(change);
    fitter.add(lookAt(line(0.0, 4.0, 0.0), kBelow));
    return fitter.add(lookAt(line(0.0, 4.0, 0.05), kAbove)).associated;
  };
  EXPECT_EQ(associated({}), 81u);
  EXPECT_EQ(associated([](auto& options) { options.association = SegmentAssociation::Surface; }), 0u);
}

TEST(Leal2000, AssociationTestsTheMeanOfTheSamples) {
  // The heading is known to 0.1 rad. At 30 m, the mean of the samples is 30 m (1 - exp(-0.1^2 / 2)) = 15 cm nearer to
  // the sensor than the end of the beam. The polygon reaches 10 cm from the wall.
  const auto associated = [](SegmentAssociation association, double heading) {
    SegmentFitter fitter = asPrinted([&](auto& options) {
      options.association = association;
      options.particles.samples = 3000;
      options.particles.per_metre = 1e5;
    });
    const Vector<2> sensor(2.0, -30.0);
    fitter.add(lookAt(line(0.0, 4.0, 0.0), sensor));
    LaserScan scan = lookAt(line(1.9, 2.1, 0.0), sensor);
    scan.pose.covariance(2, 2) = heading * heading;
    return fitter.add(scan).associated;
  };
  EXPECT_EQ(associated(SegmentAssociation::Polygon, 0.1), 0u);
  EXPECT_EQ(associated(SegmentAssociation::Surface, 0.1), 5u);
  EXPECT_EQ(associated(SegmentAssociation::Polygon, 0.01), 5u);
}

TEST(Leal2000, OnlyLinkedSegmentsAreMerged) {
  // Two parts of a wall, 40 cm apart, from two scans: no neighbouring beams link them.
  const auto segments = [](const Change& change) {
    SegmentFitter fitter = asPrinted(change);
    fitter.add(lookAt(line(0.0, 2.0, 0.0), kBelow));
    fitter.add(lookAt(line(2.45, 4.0, 0.0), kBelow));
    return fitter.add(lookAt(line(2.45, 4.0, 0.0), kBelow)).segments;
  };
  EXPECT_EQ(segments({}), 2u);
  EXPECT_EQ(segments([](auto& options) { options.merge_candidates = MergeCandidates::Near; }), 1u);
}

TEST(Leal2000, AHoleDoesNotSplitASegment) {
  const auto segments = [](const Change& change) {
    SegmentFitter fitter = asPrinted(change);
    fitter.add(lookAt(line(0.0, 4.0, 0.0), kBelow));
    std::vector<Vector<2>> both_ends = line(0.0, 1.0, 0.0);
    for (const Vector<2>& point : line(3.0, 4.0, 0.0)) both_ends.push_back(point);
    SegmentStatistics last;
    for (int scan = 0; scan < 80; ++scan) last = fitter.add(lookAt(both_ends, kBelow));
    EXPECT_EQ(evidenceWithin(fitter, 1.2, 2.8), 0u);  // forgotten
    return last.segments;
  };
  EXPECT_EQ(segments({}), 1u);
  EXPECT_EQ(segments([](auto& options) { options.split_holes = true; }), 2u);
}

TEST(Leal2000, MapLeavesTheEndsAsTheyAreFitted) {
  // A wall ends 10 cm in front of another one. They were seen by different scans, so they are not linked.
  const auto end = [](const Change& change) {
    SegmentFitter fitter = asPrinted([&](auto& options) {
      options.growth = 0.05;  // the polygon of the wall does not reach the other one
      if (change) change(options);
    });
    fitter.add(lookAt(line(0.0, 3.0, 0.0), kBelow));
    std::vector<Vector<2>> upright;
    for (const Vector<2>& point : line(-2.0, -1.0, 0.0)) upright.emplace_back(3.12, point.x());
    for (const Vector<2>& point : line(-0.95, 2.0, 0.0)) upright.emplace_back(3.12, point.x());
    fitter.add(lookAt(upright, {-3.0, 0.0}));
    double most = 0.0;
    for (const Segment& segment : fitter.map().segments)
      if (std::abs(segment.direction().x()) > 0.9) most = std::max({most, segment.start.x(), segment.end.x()});
    return most;
  };
  EXPECT_NEAR(end({}), 3.02, 0.04);
  EXPECT_NEAR(end([](auto& options) { options.adjust_ends = true; }), 3.12, 0.01);
}

TEST(Leal2000, RaysThroughASegmentDoNotDeleteIt) {
  const auto segments = [](const Change& change) {
    SegmentFitter fitter = asPrinted(change);
    fitter.add(lookAt(line(1.0, 2.5, 0.0), kBelow));
    SegmentStatistics last;
    for (int scan = 0; scan < 40; ++scan) last = fitter.add(lookAt(line(0.0, 4.0, 2.0), kBelow));
    return last.segments;
  };
  EXPECT_EQ(segments({}), 2u);
  EXPECT_EQ(segments([](auto& options) { options.prune = true; }), 1u);
}

TEST(Leal2000, MapDoesNotOptimiseAllSegments) {
  const auto segments = [](bool optimise) {
    SegmentFitterOptions options = SegmentFitterOptions::leal2000();
    EXPECT_FALSE(options.optimise);
    options.optimise |= optimise;
    SegmentFitter fitter(options);              // DescriptionLengthUtility allows the optimisation
    fitter.add(lookAt({{2.0, -3.0}}, kBelow));  // seen once, then never
    for (int scan = 0; scan < 40; ++scan) fitter.add(lookAt(line(0.0, 4.0, 0.0), kBelow));
    return fitter.map().segments.size();
  };
  EXPECT_EQ(segments(false), 2u);
  EXPECT_EQ(segments(true), 1u);
}

TEST(Leal2000, TheUtilityVotesAfterEachScanAlsoIfNoParticleIsGained) {
  // The segment is full, so its weight no longer grows. Then observations 9 cm beside it replace its particles.
  SegmentFitter fitter = asPrinted();
  for (int scan = 0; scan < 40; ++scan) fitter.add(lookAt(line(0.0, 4.0, 0.0), kBelow));
  const std::size_t full = fitter.evidence().size();
  std::vector<Vector<2>> rough = line(0.0, 4.0, 0.0);
  for (std::size_t i = 0; i < rough.size(); ++i) rough[i].y() = i % 2 == 0 ? 0.09 : -0.09;
  const SegmentStatistics step = fitter.add(lookAt(rough, kBelow));
  EXPECT_EQ(step.associated, 81u);
  EXPECT_GT(step.splits, 0u);
  EXPECT_NEAR(static_cast<double>(fitter.evidence().size()), static_cast<double>(full), 60.0);
}

}  // namespace
}  // namespace gaussmap
