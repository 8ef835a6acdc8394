// SPDX-License-Identifier: BSD-3-Clause
// Sensor models and observers that the user gives to a SegmentFitter.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/scan_makers.h"

namespace gaussmap {
namespace {

/// A sensor whose range is wrong by one of some errors, each with its weight.
struct RangeErrors : ObservationModel {
  std::vector<std::pair<double, double>> errors;  // error [m], weight
  void observe(const LaserScan& scan, std::size_t beam, std::uint64_t,
               std::vector<ObservationPoint>& points) const override {
    points.clear();
    LaserScan moved = scan;
    for (const auto& [error, weight] : errors) {
      moved.ranges[beam] = scan.ranges[beam] + error;
      points.push_back({moved.hit(beam), weight});
    }
  }
};

std::shared_ptr<RangeErrors> model(std::vector<std::pair<double, double>> errors) {
  const auto made = std::make_shared<RangeErrors>();
  made->errors = std::move(errors);
  return made;
}

/// Returns an exact scan of the wall x = 5 from the origin, with bearings from -0.3 to 0.3 rad.
LaserScan wallScan() {
  LaserScan scan;
  for (int i = -30; i <= 30; ++i) {
    scan.bearings.push_back(0.01 * i);
    scan.ranges.push_back(5.0 / std::cos(0.01 * i));
  }
  return scan;
}

/// Returns the mean of cos^2 of the bearings: the share of a range error's square that is across the wall.
double acrossShare() {
  double sum = 0.0;
  for (const double bearing : wallScan().bearings) sum += std::pow(std::cos(bearing), 2);
  return sum / static_cast<double>(wallScan().bearings.size());
}

double varianceWith(SegmentFitterOptions options, std::shared_ptr<const ObservationModel> sensor) {
  options.optimise = options.adjust_ends = false;
  const auto never = std::make_shared<UserUtility>();
  never->nothing_vote = [](const SegmentGoals&) { return 0.0; };
  SegmentFitter fitter(options, never, std::move(sensor));
  fitter.add(wallScan());
  const SegmentMap map = fitter.map();
  EXPECT_EQ(map.segments.size(), 1u);
  return map.segments.at(0).normal_variance;
}

TEST(SegmentFitter, TakesATwoPeakedSensor) {
  const double share = acrossShare();
  const auto sensor = model({{-0.2, 0.25}, {0.1, 0.75}});  // mean 0.025 m, variance .01 + .0075 - .000625 = .016875
  EXPECT_NEAR(varianceWith({}, sensor), 0.016875 * share, 2e-4);
  SegmentFitterOptions particles;
  particles.policy = EvidencePolicy::ParticleSets;
  particles.particles.samples = 40;  // of 40 particles, 10 are at the first peak and 30 at the second
  particles.particles.per_metre = 1e6;
  EXPECT_NEAR(varianceWith(particles, sensor), 0.016875 * share, 2e-4);
}

TEST(SegmentFitter, TakesAUniformSensor) {
  std::vector<std::pair<double, double>> errors;
  for (int i = 0; i < 100; ++i) errors.emplace_back(-0.15 + 0.003 * (i + 0.5), 0.01);
  // Uniform from -15 cm to 15 cm: .3^2 / 12 = .0075.
  EXPECT_NEAR(varianceWith({}, model(errors)), 0.0075 * acrossShare(), 1e-4);
  SegmentFitterOptions particles = SegmentFitterOptions::leal2000();
  particles.particles.per_metre = 1e6;
  EXPECT_NEAR(varianceWith(particles, model(errors)), 0.0075 * acrossShare(), 3e-4);
}

TEST(SegmentFitter, ARejectedObservationModelLeavesTheMapUnchanged) {
  const auto refused = [](std::vector<std::pair<double, double>> errors, const std::string& word) {
    const auto sensor = model({{0.0, 1.0}});
    SegmentFitter fitter({}, {}, sensor);
    fitter.add(wallScan());
    sensor->errors = std::move(errors);
    try {
      fitter.add(wallScan());
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("observation model: beam 0: "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
    EXPECT_EQ(fitter.scans(), 1u);
    EXPECT_EQ(fitter.map().segments.at(0).weight, 61.0);
  };
  refused({}, "sum to 0");
  refused({{0.0, 0.5}}, "sum to 0.5");
  refused({{0.0, 1.5}, {0.1, -0.5}}, "-0.5");
  refused({{std::numeric_limits<double>::infinity(), 1.0}}, "not finite");
}

// A corridor of 40 m. Its upper wall has a step of 25 cm every 80 cm.
std::vector<Segment> steppedCorridor() {
  using test::wall;
  std::vector<Segment> walls = {wall(-2.0, -1.0, 40.0, -1.0), wall(40.0, -1.0, 40.0, 1.5), wall(-2.0, 1.5, -2.0, -1.0)};
  for (double x = 40.0; x > -2.0; x -= 1.6) {
    walls.push_back(wall(x, 1.5, x - 0.8, 1.5));
    walls.push_back(wall(x - 0.8, 1.5, x - 0.8, 1.25));
    walls.push_back(wall(x - 0.8, 1.25, x - 1.6, 1.25));
    walls.push_back(wall(x - 1.6, 1.25, x - 1.6, 1.5));
  }
  return walls;
}

std::size_t segmentsNear(const SegmentMap& map, double x) {
  return static_cast<std::size_t>(std::count_if(map.segments.begin(), map.segments.end(), [&](const Segment& s) {
    return std::abs(0.5 * (s.start.x() + s.end.x()) - x) < 3.0 && s.start.y() > 1.0;
  }));
}

TEST(SegmentFitter, AnObserverInTheFinishedMapGetsDetailThatIsGivenUpBehindIt) {
  const std::vector<Segment> walls = steppedCorridor();
  ViewpointDependentOptions view;
  view.far = {0.04, 3.0, 0.5};
  view.radius = 4.0;
  view.scale = 0.2;
  for (const EvidencePolicy policy : {EvidencePolicy::MomentCells, EvidencePolicy::ParticleSets}) {
    SegmentFitterOptions options;
    options.policy = policy;
    SegmentFitter fitter(options, std::make_shared<ViewpointDependentUtility>(view));
    Random random(1);
    for (int i = 0; i <= 80; ++i) fitter.add(test::look(walls, 0.4 * i, 0.0, 0.0, 0.005, random));
    fitter.observe({0.0, 1000.0});  // nobody in the corridor
    const SegmentMap nobody = fitter.map();
    const SegmentStatistics first = fitter.observe({8.0, 0.0});
    EXPECT_GT(first.splits, 0u);
    EXPECT_EQ(first.beams, 0u);
    EXPECT_EQ(first.segments, fitter.map().segments.size());
    EXPECT_GE(segmentsNear(fitter.map(), 8.0), segmentsNear(nobody, 8.0) + 2);
    EXPECT_EQ(segmentsNear(fitter.map(), 24.0), segmentsNear(nobody, 24.0));
    const std::size_t there = segmentsNear(fitter.map(), 8.0);
    const SegmentStatistics second = fitter.observe({24.0, 0.0});
    EXPECT_GT(second.merges, 0u);
    EXPECT_GE(segmentsNear(fitter.map(), 24.0), segmentsNear(nobody, 24.0) + 2);
    EXPECT_LT(segmentsNear(fitter.map(), 8.0), there);
    EXPECT_EQ(fitter.scans(), 81u);
  }
}

TEST(SegmentFitter, AnObserverChangesNothingIfTheUtilityDoesNotDependOnIt) {
  Random random(1);
  SegmentFitter fitter;
  fitter.add(test::look(test::room(-3.0, -2.0, 4.0, 3.0), 0.0, 0.0, 0.0, 0.02, random));
  const SegmentMap before = fitter.map();
  const SegmentStatistics step = fitter.observe({1.0, 1.0});
  EXPECT_EQ(step.splits + step.merges, 0u);
  EXPECT_EQ(fitter.map().segments.at(0).start, before.segments.at(0).start);
  EXPECT_THROW(fitter.observe({std::nan(""), 0.0}), std::invalid_argument);
  EXPECT_EQ(SegmentFitter().observe({0.0, 0.0}).segments, 0u);
}

}  // namespace
}  // namespace gaussmap
