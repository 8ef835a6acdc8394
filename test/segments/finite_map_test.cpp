// SPDX-License-Identifier: BSD-3-Clause
// Whatever the evidence and the utility, every number of a segment map is one.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_fitter.h"
#include "simulation/simulation.h"

namespace gaussmap {
namespace {

std::vector<LaserScan> planScans() {
  static const std::vector<LaserScan> scans = [] {
    std::vector<LaserScan> made;
    const Simulation plan = makeSimulation(WorldName::Plan, {160, false});
    for (std::size_t i = 0; i < plan.trajectory.size(); ++i) {
      const SimulatedScan scan = simulateScan(plan, i);
      made.push_back(planarScan({scan.points, scan.pose, 0}));
    }
    return made;
  }();
  return scans;
}

void expectNumbers(const SegmentMap& map) {
  EXPECT_GT(map.segments.size(), 5u);
  for (const Segment& segment : map.segments) {
    EXPECT_TRUE(segment.start.allFinite() && segment.end.allFinite());
    EXPECT_TRUE(segment.covariance.allFinite());
    EXPECT_EQ(Eigen::LLT<Eigen::Matrix2d>(segment.covariance).info(), Eigen::Success);
    EXPECT_TRUE(std::isfinite(segment.normal_variance) && segment.normal_variance >= 0.0);
    EXPECT_GT(segment.weight, 0.0);
  }
}

class FiniteSegmentMap : public testing::TestWithParam<std::tuple<EvidencePolicy, ParticleLimit>> {
 protected:
  /// The map after every tenth scan, as add() left it and refined.
  void expectNumbersAllAlong(const std::shared_ptr<SegmentUtility>& utility) {
    for (const bool refine : {false, true}) {
      SegmentFitterOptions options;
      options.policy = std::get<0>(GetParam());
      options.particles.limit = std::get<1>(GetParam());
      if (options.particles.limit == ParticleLimit::Segment) {  // nearly everything is forgotten again
        options.particles.samples = 3;
        options.particles.per_metre = 1.5;
      }
      options.optimise = refine;
      SegmentFitter fitter(options, utility);
      int count = 0;
      for (const LaserScan& scan : planScans()) {
        const SegmentStatistics statistics = fitter.add(scan);
        ASSERT_TRUE(std::isfinite(statistics.normal_variance)) << count;
        if (++count % 10 == 0) expectNumbers(fitter.map());
      }
    }
  }
};

INSTANTIATE_TEST_SUITE_P(All, FiniteSegmentMap,
                         testing::Values(std::tuple(EvidencePolicy::MomentCells, ParticleLimit::Bins),
                                         std::tuple(EvidencePolicy::ParticleSets, ParticleLimit::Bins),
                                         std::tuple(EvidencePolicy::ParticleSets, ParticleLimit::Segment)));

TEST_P(FiniteSegmentMap, ByDescriptionLength) {
  expectNumbersAllAlong(std::make_shared<DescriptionLengthUtility>());
}

TEST_P(FiniteSegmentMap, ByTheFixedViewpoint) {
  expectNumbersAllAlong(std::make_shared<ViewpointInvariantUtility>());
}

TEST_P(FiniteSegmentMap, ByTheViewpointOfTheSensor) {
  expectNumbersAllAlong(std::make_shared<ViewpointDependentUtility>());
}

}  // namespace
}  // namespace gaussmap
