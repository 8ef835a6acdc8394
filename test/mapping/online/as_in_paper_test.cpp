// SPDX-License-Identifier: BSD-3-Clause
// OnlineOptions::yguel2009() and each of its settings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/pi.h"
#include "gaussmap/core/gaussian.h"
#include "mapping/online/online_scenes.h"
#include "mapping/online/online_state.h"

namespace gaussmap::test {
namespace {

using namespace detail;

/// The settings of the paper, with cells that suit the scenes, one refinement every four scans, and one thread.
OnlineOptions paperOptions() {
  OnlineOptions options = OnlineOptions::yguel2009(3);
  options.map = {0.2, 5, 3, 0.0};
  options.refine_every = 4;
  options.threads = 1;
  return options;
}

/// The mean log-odds of the finest clusters whose mean is in an interval of x.
double meanLogOdds(const GaussianMap<3>& map, double x0, double x1) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) {
    const double x = map.gaussian(i, 0).mean.x();
    if (x < x0 || x > x1) continue;
    sum += double(map.logOdds(i, 0));
    count += 1.0;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// Twelve scans of a wall: a box leaves after the first three, another box comes for one scan, and behind the sensor
/// lies a bent wall that only the first four scans see.
std::vector<Scan> driveScans() {
  LidarOptions sparse = wallLidar();
  sparse.rings = 20;
  sparse.columns = 360;
  std::vector<Scan> scans;
  for (int i = 0; i < 12; ++i) {
    std::vector<double> boxes = {2.5};
    if (i < 3) boxes.push_back(-0.5);
    if (i == 6) boxes.push_back(-3.0);
    Scan scan = boxScan(boxes, sparse);
    if (i < 3)  // a pole hangs from the box down to where later scans see nothing
      for (int k = 0; k < 60; ++k) scan.points.push_back({5.1, 0.0, -0.6 - 0.01 * k});
    if (i < 4)
      for (int row = -8; row < 9; ++row)
        for (int column = -40; column <= 40; ++column) {
          const double y = 0.05 * column, z = 0.1 * row;
          scan.points.push_back({-4.0 + std::abs(y), y, z});
        }
    scan.pose.translation = {0.02 * i, 0.03 * i, 0.0};
    scans.push_back(scan);
  }
  return scans;
}

GaussianMap<3> mapOf(const std::vector<Scan>& scans, const OnlineOptions& options) {
  OnlineMapper<3> mapper(options);
  for (const Scan& scan : scans) mapper.add(scan);
  return mapper.map();
}

TEST(OnlineAsInPaper, EverySettingThatIsLostChangesTheMap) {
  const std::vector<Scan> scans = driveScans();
  const OnlineOptions usual;
  const GaussianMap<3> map = mapOf(scans, paperOptions());
  EXPECT_TRUE(sameMap(map, mapOf(scans, paperOptions())));
  const std::vector<std::pair<std::string, std::function<void(OnlineOptions&)>>> losses = {
      {"learning_rate", [&](auto& o) { o.learning_rate = usual.learning_rate; }},
      {"slowest_rate", [&](auto& o) { o.slowest_rate = 5e-3; }},
      {"fastest_rate", [&](auto& o) { o.fastest_rate = 6e-2; }},
      {"max_log_odds", [&](auto& o) { o.occupancy.max_log_odds = 9.0; }},
      {"hit_rule", [&](auto& o) { o.hit_rule = usual.hit_rule; }},
      {"samples", [&](auto& o) { o.samples = usual.samples; }},
      {"sample_range", [&](auto& o) { o.sample_range = usual.sample_range; }},
      {"max_samples", [&](auto& o) { o.max_samples = usual.max_samples; }},
      {"occupancy_every", [&](auto& o) { o.occupancy_every = usual.occupancy_every; }},
      {"look_back", [&](auto& o) { o.look_back = usual.look_back; }},
      {"reach", [&](auto& o) { o.reach = usual.reach; }},
      {"refine_every", [&](auto& o) { o.refine_every = 5; }},
      {"refine_cells", [&](auto& o) { o.refine_cells = usual.refine_cells; }},
      {"method", [&](auto& o) { o.method = usual.method; }},
      {"seed_rule", [&](auto& o) { o.seed_rule = usual.seed_rule; }},
      {"refine_area", [&](auto& o) { o.refine_area = usual.refine_area; }},
  };
  for (const auto& [name, lose] : losses) {
    OnlineOptions options = paperOptions();
    lose(options);
    EXPECT_FALSE(sameMap(map, mapOf(scans, options))) << name;
  }
}

TEST(OnlineAsInPaper, TheFactorOfTheErrorChangesTheErrors) {
  const std::vector<Scan> scans = driveScans();
  const auto errors = [&](ErrorFactor factor) {
    OnlineOptions options = paperOptions();
    options.error_factor = factor;
    OnlineMapper<3> mapper(options);
    for (int i = 0; i < 3; ++i) mapper.add(scans[std::size_t(i)]);
    return mapper.add(scans[3]).errors;
  };
  const std::vector<double> paper = errors(OnlineOptions::yguel2009(3).error_factor), plain = errors(ErrorFactor::One);
  for (std::size_t scale = 1; scale < 3; ++scale) {
    EXPECT_LT(paper[scale], (1.0 - 5e-4) * plain[scale]);
    EXPECT_GT(paper[scale], (1.0 - 5e-2) * plain[scale]);
  }
}

TEST(OnlineAsInPaper, HasTheCellsAndNumbersOfThePaper) {
  for (const int dimensions : {2, 3}) {
    const OnlineOptions options = OnlineOptions::yguel2009(dimensions);
    EXPECT_EQ(options.map.resolution, dimensions == 2 ? 0.05 : 0.1);
    EXPECT_EQ(options.map.ratio, 10);
    EXPECT_EQ(options.map.scales, 3);
    EXPECT_EQ(options.occupancy_every, dimensions == 2 ? 1 : 3);
    EXPECT_EQ(options.refine_every, 10);
    EXPECT_EQ(options.refine_cells, 4u);
    EXPECT_EQ(options.occupancy.max_log_odds, 10.0);
  }
}

TEST(OnlineAsInPaper, GivesTheSameBytesForOneAndTwoThreads) {
  const std::vector<Scan> scans = driveScans();
  OnlineOptions two = paperOptions();
  two.threads = 2;
  EXPECT_TRUE(sameMap(mapOf(scans, paperOptions()), mapOf(scans, two)));
}

TEST(OnlineAsInPaper, TheRangeImageRaisesWhatIsAtASurfaceAlsoWithoutAPoint) {
  // One cell of the wall gets points in the first scan only; the beams around it still end at the wall.
  const Scan wall = wallScan(false);
  Scan hole = wall;
  const auto is_in_hole = [](const Eigen::Vector3d& p) {
    return std::max(std::abs(p.y() - 0.1), std::abs(p.z() - 0.1)) < 0.1001;
  };
  hole.points.erase(std::remove_if(hole.points.begin(), hole.points.end(), is_in_hole), hole.points.end());
  ASSERT_LT(hole.points.size(), wall.points.size());
  for (const HitRule rule : {HitRule::Points, HitRule::RangeImage}) {
    OnlineOptions options = wallOptions();
    options.hit_rule = rule;
    options.projection = findProjection(wall.points);
    OnlineMapper<3> mapper(options);
    mapper.add(wall);
    mapper.add(hole);
    const GaussianMap<3> map = mapper.map();
    const auto cell = map.find(map.grid().keyOf({10.1, 0.1, 0.1}), 0);
    ASSERT_TRUE(cell);
    EXPECT_FLOAT_EQ(map.logOdds(*cell, 0), rule == HitRule::Points ? 0.85f : 1.7f);
  }
}

TEST(OnlineAsInPaper, TheRangeImageLowersWhatIsSeenThroughAndLeavesWhatIsHidden) {
  OnlineOptions options = wallOptions();
  options.hit_rule = HitRule::RangeImage;
  options.forget = false;
  OnlineMapper<3> mapper(options);
  mapper.add(wallScan(false));  // the wall: +0.85
  mapper.add(wallScan(true));   // the box: +0.85; the wall behind it: hidden
  const GaussianMap<3> hidden = mapper.map();
  const auto behind = hidden.find(hidden.grid().keyOf({10.1, 0.1, 0.1}), 0);
  ASSERT_TRUE(behind);
  EXPECT_FLOAT_EQ(hidden.logOdds(*behind, 0), 0.85f);
  EXPECT_NEAR(meanLogOdds(hidden, 4.0, 6.0), 0.85, 1e-6);
  mapper.add(wallScan(false));  // the box: -0.4
  mapper.add(wallScan(false));
  const GaussianMap<3> seen = mapper.map();
  const auto inside = seen.find(seen.grid().keyOf({5.1, 0.1, 0.1}), 0);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(seen.logOdds(*inside, 0), 0.05, 1e-6);
  EXPECT_FLOAT_EQ(seen.logOdds(*seen.find(seen.grid().keyOf({10.1, 0.1, 0.1}), 0), 0), 2.55f);
}

TEST(OnlineAsInPaper, ACoarseClusterHasItsOwnOccupancy) {
  // A box and the wall in one coarsest cell of 10 m: the mean of their cluster is in the free space between them. The
  // points hit it, but the range image shows that the beams pass through it.
  for (const HitRule rule : {HitRule::Points, HitRule::RangeImage}) {
    OnlineOptions options = wallOptions();
    options.map = {0.4, 5, 3, 0.0};
    options.hit_rule = rule;
    OnlineMapper<3> mapper(options);
    Scan scan = boxScan({3.0});
    for (Eigen::Vector3d& point : scan.points) point *= 0.9;  // the wall at x = 9.09, the box at x = 4.59
    for (int i = 0; i < 2; ++i) mapper.add(scan);
    const GaussianMap<3> map = mapper.map();
    float lowest = 100.0f;
    for (std::size_t i = 0; i < map.gaussianCount(2); ++i) lowest = std::min(lowest, map.logOdds(i, 2));
    EXPECT_FLOAT_EQ(lowest, rule == HitRule::Points ? 1.7f : -0.8f);
    EXPECT_GT(meanLogOdds(map, 9.0, 9.2), 1.6);  // at the edges of the box, some cells are hidden
  }
}

TEST(OnlineAsInPaper, AClusterChangesByTheMeanOverItsSamples) {
  // Half of the points of each wide cell lie on the wall, half of them in front of it, where later beams pass through.
  OnlineOptions options = wallOptions();
  options.map = {4.0, 2, 1, 0.0};
  options.hit_rule = HitRule::RangeImage;
  options.samples = OccupancySamples::Random;
  options.sample_range = SampleRange::CellCentre;
  options.max_samples = 0;
  options.projection = findProjection(wallScan(false).points);
  OnlineMapper<3> mapper(options);
  Scan scan = wallScan(false);
  const std::size_t wall = scan.points.size();
  for (std::size_t i = 0; i < wall; i += 2) scan.points.push_back(0.85 * scan.points[i]);
  mapper.add(scan);
  const GaussianMap<3> before = mapper.map();
  mapper.add(wallScan(false));
  const GaussianMap<3> after = mapper.map();
  // The same mean over other samples, and many more of them.
  const RangeImage image(*options.projection, wallScan(false).points);
  Random random(5);
  std::size_t mixed = 0;
  for (std::size_t i = 0; i < after.gaussianCount(0); ++i) {
    const GaussianSampler<3> sampler(after.localGaussian(i, 0));
    const Eigen::Vector3d centre = after.grid().centre(after.scale(0).keys[i], 0);
    double sum = 0.0, inside = 0.0;
    for (int k = 0; k < 20000; ++k) {
      const Eigen::Vector3d point = sampler(random);
      if (point.cwiseAbs().maxCoeff() > 2.0) continue;
      inside += 1.0;
      const Visibility seen = visibilityOf(image, centre + point);
      sum += seen == Visibility::AtSurface ? 0.85 : seen == Visibility::PassedThrough ? -0.4 : 0.0;
    }
    const double change = double(after.logOdds(i, 0)) - double(before.logOdds(i, 0));
    EXPECT_NEAR(change, sum / inside, 0.12) << i;  // about 500 samples
    mixed += std::abs(change) < 0.3;
  }
  EXPECT_GE(mixed, 3u);
}

TEST(OnlineAsInPaper, TheNumberOfSamplesIsThatOfEquationOne) {
  const double degree = kPi / 180.0;
  SphericalProjection lidar;
  for (int row = 0; row <= 20; ++row) lidar.row_borders.push_back((row - 10) * degree);
  lidar.columns = 360;  // a pixel is one degree wide and high
  // 3 pi / (4 p) (a / delta)^2 = 3 pi / 4 (57.2958 * 0.2 / 4)^2 = 19.34 pixels
  EXPECT_EQ(samplesFor(lidar, 4.0, 0.2, 1e9), 20);
  EXPECT_EQ(samplesFor(lidar, 8.0, 0.2, 1e9), 5);  // a quarter: 4.83
  EXPECT_EQ(samplesFor(lidar, 4.0, 2.0, 1e9), 1934);
  EXPECT_EQ(samplesFor(lidar, 4.0, 2.0, 100.0), 100);
  EXPECT_EQ(samplesFor(lidar, 400.0, 0.2, 1e9), 1);
  EXPECT_EQ(samplesFor(lidar, 0.0, 0.2, 7200.0), 7200);  // at the sensor: all pixels of the image
  // A camera: p = 1 / (fx fy) on the plane z = 1. 3 pi / 4 * 100 * 50 * (0.1 / 2)^2 = 29.45
  EXPECT_EQ(samplesFor(PlanarProjection{100, 50, 50, 25, 100, 50}, 2.0, 0.1, 1e9), 30);
}

TEST(OnlineAsInPaper, TheErrorCountsAnUncertainClusterLess) {
  const auto errors = [](ErrorFactor factor, LearningRate rate) {
    OnlineOptions options = wallOptions();
    options.learning_rate = rate;
    options.error_factor = factor;
    options.refine_every = 1;
    OnlineMapper<3> mapper(options);
    return mapper.add(wallScan(true)).errors;
  };
  const std::vector<double> plain = errors(ErrorFactor::One, LearningRate::Occupancy);
  const std::vector<double> weighted = errors(ErrorFactor::OneMinusRate, LearningRate::Occupancy);
  // After one scan, all log-odds are 0.85.
  const double rate = (5e-4 - 5e-2) / 20.0 * (double(0.85f) + 10.0) + 5e-2;
  for (std::size_t scale = 1; scale < 3; ++scale) {
    ASSERT_GT(plain[scale], 0.0);
    EXPECT_NEAR(weighted[scale], (1.0 - rate) * plain[scale], 1e-12 * plain[scale]);
  }
  EXPECT_EQ(errors(ErrorFactor::One, LearningRate::SampleMean),
            errors(ErrorFactor::OneMinusRate, LearningRate::SampleMean));
}

TEST(OnlineAsInPaper, OnlyVisibleCellsAreRefined) {
  // The sensor first sees the wall with a box, then turns round to a small piece of another wall.
  for (const RefineArea area : {RefineArea::Known, RefineArea::Visible}) {
    OnlineOptions options = wallOptions();
    options.method = RefineMethod::Insert;
    options.refine_area = area;
    options.refine_cells = 5;
    options.refine_every = 1;
    OnlineMapper<3> mapper(options);
    mapper.add(wallScan(true));
    const std::size_t before = mapper.map().gaussianCount(1);
    Scan other = wallScan(false);
    const auto is_far = [](const Eigen::Vector3d& p) { return std::abs(p.y()) > 0.3 || std::abs(p.z()) > 0.3; };
    other.points.erase(std::remove_if(other.points.begin(), other.points.end(), is_far), other.points.end());
    other.pose.rotation = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitZ());
    mapper.add(other);
    const GaussianMap<3> map = mapper.map();
    std::size_t in_front = 0;
    for (std::size_t i = 0; i < map.gaussianCount(1); ++i) in_front += map.gaussian(i, 1).mean.x() > 0.0;
    EXPECT_EQ(in_front > before, area == RefineArea::Known);
  }
}

TEST(OnlineAsInPaper, TheThresholdDecidesWhenAClusterIsDeleted) {
  const auto viewsUntilDeleted = [](double forget_below) {
    OnlineOptions options = wallOptions();
    options.forget_below = forget_below;
    OnlineMapper<3> mapper(options);
    mapper.add(wallScan(true));
    mapper.add(wallScan(true));  // two hits give 1.7, each view takes 0.4
    int views = 1;
    while (views < 20 && mapper.add(wallScan(false)).deleted == 0) ++views;
    return views;
  };
  EXPECT_EQ(viewsUntilDeleted(0.0), 5);
  EXPECT_EQ(viewsUntilDeleted(0.6), 3);
  EXPECT_EQ(viewsUntilDeleted(-1.0), 7);
  EXPECT_EQ(viewsUntilDeleted(-10.0), 20);  // never
}

TEST(OnlineAsInPaper, ForgetsAtEveryScaleInThePlane) {
  OnlineOptions options = OnlineOptions::yguel2009(2);
  options.map.resolution = 0.2;
  options.threads = 1;
  OnlineMapper<2> mapper(options);
  const auto line = [](bool with_box) {
    Scan scan;
    for (int i = -90; i <= 90; ++i) {
      const double azimuth = 0.5 * i * kPi / 180.0;
      const double wall = 10.1 / std::cos(azimuth), box = 5.1 / std::cos(azimuth);
      const bool hits_box = with_box && std::abs(5.1 * std::tan(azimuth)) < 0.5;
      const double range = hits_box ? box : wall;
      scan.points.push_back({range * std::cos(azimuth), range * std::sin(azimuth), 0.0});
    }
    return scan;
  };
  const auto inFront = [&](int scale) {
    const GaussianMap<2> map = mapper.map();
    std::size_t count = 0;
    for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) count += map.gaussian(i, scale).mean.x() < 7.0;
    return count;
  };
  for (int i = 0; i < 2; ++i) mapper.add(line(true));
  EXPECT_GT(inFront(0), 0u);
  for (int i = 0; i < 10; ++i) mapper.add(line(false));
  for (int scale = 0; scale < 2; ++scale) EXPECT_EQ(inFront(scale), 0u) << scale;
}

}  // namespace
}  // namespace gaussmap::test
