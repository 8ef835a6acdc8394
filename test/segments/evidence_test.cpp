// SPDX-License-Identifier: BSD-3-Clause
#include "segments/evidence.h"

#include <gtest/gtest.h>

namespace gaussmap::detail {
namespace {

/// A wall of 4 m is seen whole once, then its right half 50 times. What is left of the left half: the share of its
/// weight among all evidence, and how many cells of it are left.
struct Memory {
  double weight = 0.0;
  std::size_t cells = 0;
  std::size_t particles = 0;
};

Memory lookAtOneHalf(const SegmentFitterOptions& options) {
  const auto keeper = makeEvidenceKeeper(options);
  SegmentEvidence evidence;
  evidence.row = CellRow({0.0, 0.0}, {1.0, 0.0}, 0.1);
  Random random(1);
  std::uint64_t number = 0;
  const auto see = [&](double from) {
    for (double x = from; x < 4.0; x += 0.05) {
      std::vector<ObservationPoint> points;
      for (int i = 0; i < options.particles.samples; ++i) {
        // One after the other: compilers differ in the order of arguments.
        const double across = 0.02 * random.normal(), along = x + 0.02 * random.normal();
        points.push_back({Vector<2>(along, across), 1.0 / options.particles.samples});
      }
      keeper->add(points, 4.0, number++, evidence);
    }
  };
  for (std::uint64_t scan = 0; scan <= 50; ++scan) {
    see(scan == 0 ? 0.0 : 2.0);
    keeper->settle(scan, evidence);
  }
  Memory memory;
  memory.particles = evidence.particles.size();
  for (const SegmentCell& cell : evidence.row.cells())
    if (cell.hits.n > 0.0 && cell.hits.mean().x() < 1.9) {
      memory.weight += cell.hits.n;
      ++memory.cells;
    }
  return memory;
}

TEST(EvidenceKeepers, ThePapersResamplingForgetsWhatIsNotLookedAtMomentsAndBinsDoNot) {
  SegmentFitterOptions options;
  const Memory moments = lookAtOneHalf(options);
  EXPECT_NEAR(moments.weight, 38.0, 1.5);  // an observation every 5 cm, all of them
  EXPECT_EQ(moments.cells, 19u);

  options.policy = EvidencePolicy::ParticleSets;
  options.particles.limit = ParticleLimit::Segment;
  const Memory literal = lookAtOneHalf(options);
  EXPECT_EQ(literal.particles, 1200u);  // 300 a metre
  EXPECT_EQ(literal.cells, 0u);

  options.particles.limit = ParticleLimit::Bins;
  const Memory bins = lookAtOneHalf(options);
  EXPECT_GT(bins.weight, 15.0);  // 300 / 30 observations a metre
  EXPECT_GE(bins.cells, 18u);
  EXPECT_LE(bins.particles, 1300u);
}

TEST(EvidenceKeepers, TheParticlesOfASegmentAreBoundedByItsLengthAndMinimumLength) {
  SegmentFitterOptions options;
  options.policy = EvidencePolicy::ParticleSets;
  options.particles.limit = ParticleLimit::Segment;
  options.min_length = 0.2;  // at most 10 * 0.2 m * 300 particles
  EXPECT_EQ(lookAtOneHalf(options).particles, 600u);
}

TEST(SegmentEvidence, SlicesAndSumsKeepAllParticles) {
  SegmentEvidence evidence;
  evidence.row = CellRow({0.0, 0.0}, {1.0, 0.0}, 0.1);
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Vector<2> point(3.0 * random.uniform(), 0.0);
    evidence.particles.push_back(point.cast<float>());
    evidence.row.add(evidence.particles.back().cast<double>(), 1.0);
  }
  const std::size_t cells = evidence.row.cells().size();
  SegmentEvidence a = evidence.slice(0, 11);
  const SegmentEvidence b = evidence.slice(11, cells);
  EXPECT_EQ(a.particles.size() + b.particles.size(), 200u);
  EXPECT_DOUBLE_EQ(a.row.total().n, static_cast<double>(a.particles.size()));
  a.absorb(b);
  EXPECT_EQ(a.particles.size(), 200u);
  EXPECT_DOUBLE_EQ(a.row.total().n, 200.0);
}

}  // namespace
}  // namespace gaussmap::detail
