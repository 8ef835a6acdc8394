// SPDX-License-Identifier: BSD-3-Clause
// The experiments of Leal, Scheding, Dissanayake 2000 on simulated and real scans.
#include "papers_leal.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "evaluation/segment_score.h"
#include "evaluation/wall_score.h"
#include "gaussmap/segments/segment_fitter.h"
#include "segment_data.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

constexpr double kPlanNoise = 0.02;                             // of the ranges of the simulated plan [m]
constexpr double kFullTurn = 6.283185307179586;                 // [rad]
constexpr int kHallScans = 160;                                 // of the rough hall
constexpr double kStride = 2.0;                                 // between two positions of the observer [m]
constexpr double kExampleLength = 1.5, kExampleScale = 0.53;    // Figs. 4 and 5
constexpr double kObserverLength = 3.0, kObserverScale = 0.33;  // Fig. 9
constexpr double kAway = 15.0;                                  // the observer has left a place that far away [m]
const Vector<2> kWindow(7.0, 8.0);                              // Figs. 4 and 5 [m]
const Vector<2> kOutside(1e5, 1e5);                             // an observer that sees no segment [m]

constexpr double kDefaultThreshold = 0.06, kNoiseThreshold = 0.028;  // sigma_th [m]

SegmentFitterOptions optionsOf(LealMethod method, double min_length, std::uint64_t seed) {
  SegmentFitterOptions options;
  if (method == LealMethod::AsPrinted) options = SegmentFitterOptions::leal2000();
  if (method == LealMethod::Moments) options.optimise = false;
  if (method != LealMethod::Default) options.min_length = min_length;
  options.particles.seed = seed;
  return options;
}

ViewpointInvariantOptions invariantOptions(double min_length, double threshold = kDefaultThreshold) {
  ViewpointInvariantOptions options;
  options.min_length = min_length;
  options.sigma_threshold = threshold;
  return options;
}

/// Returns the utility of the paper; none for LealMethod::Default.
std::shared_ptr<SegmentUtility> invariant(LealMethod method, double min_length, double threshold = kDefaultThreshold) {
  if (method == LealMethod::Default) return {};
  return std::make_shared<ViewpointInvariantUtility>(invariantOptions(min_length, threshold));
}

ViewpointDependentOptions dependentOptions(double threshold, double min_length, double scale) {
  ViewpointDependentOptions options;
  options.far = invariantOptions(min_length, threshold);
  options.scale = scale;
  return options;
}

/// The mean sigma_n^2 of a map, over its observations [m^2].
double varianceOf(const SegmentMap& map) {
  double weight = 0.0, sum = 0.0;
  for (const Segment& segment : map.segments) {
    weight += segment.weight;
    sum += segment.weight * segment.normal_variance;
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

/// Adds all scans to a map and measures it. `is_optimised`: map() changes the segments.
LealMeasure measure(const LealData& data, const SegmentFitterOptions& options,
                    const std::shared_ptr<SegmentUtility>& utility, bool is_optimised) {
  LealMeasure result;
  SegmentFitter fitter(options, utility);
  SegmentStatistics last;
  for (const LaserScan& scan : data.scans) {
    last = fitter.add(scan);
    result.splits += static_cast<double>(last.splits);
    result.merges += static_cast<double>(last.merges);
  }
  const SegmentMap map = fitter.map();
  result.segments = static_cast<double>(map.segments.size());
  // The statistics weigh by particles, as the paper does. They do not know the map after the optimisation.
  result.normal_variance = is_optimised ? varianceOf(map) : last.normal_variance;
  result.length = map.totalLength();
  const HoldOutScore test = scoreHoldOut(map, data.test);
  result.within_5cm = test.within_5cm;
  result.within_10cm = test.within_10cm;
  result.rms = test.rms;
  result.predicted_10cm = test.predicted_10cm;
  result.blocked_early = test.blocked_early;
  if (data.walls.empty()) return result;
  const WallScore walls = scoreWalls(map, data.walls);
  result.recall = walls.recall;
  result.precision = walls.precision;
  result.true_length = 0.0;
  for (const Segment& wall : data.walls) result.true_length += wall.length();
  if (walls.matched == 0) return result;  // all walls are too short
  result.offset_rms = walls.offset_rms;
  result.angle_rms = walls.angle_rms;
  return result;
}

/// The same for a method of the study.
LealMeasure measure(const LealData& data, LealMethod method, double threshold, double min_length, std::uint64_t seed) {
  return measure(data, optionsOf(method, min_length, seed), invariant(method, min_length, threshold),
                 method == LealMethod::Default);
}

LealMeasure meanOf(const std::vector<LealMeasure>& runs) {
  LealMeasure mean;
  const auto average = [&](double LealMeasure::*member) {
    double sum = 0.0;
    for (const LealMeasure& run : runs) sum += run.*member;
    mean.*member = sum / static_cast<double>(runs.size());
  };
  for (double LealMeasure::*const member :
       {&LealMeasure::segments, &LealMeasure::splits, &LealMeasure::merges, &LealMeasure::normal_variance,
        &LealMeasure::length, &LealMeasure::within_5cm, &LealMeasure::within_10cm, &LealMeasure::rms,
        &LealMeasure::predicted_10cm, &LealMeasure::blocked_early, &LealMeasure::recall, &LealMeasure::precision,
        &LealMeasure::offset_rms, &LealMeasure::angle_rms, &LealMeasure::true_length})
    average(member);
  return mean;
}

std::vector<Vector<2>> pathOf(const std::vector<LaserScan>& scans) {
  std::vector<Vector<2>> path;
  for (const LaserScan& scan : scans)
    if (path.empty() || (scan.pose.translation - path.back()).norm() >= kStride) path.push_back(scan.pose.translation);
  return path;
}

Box<2> windowAround(const Vector<2>& middle) {
  return {middle - 0.5 * kWindow, middle + 0.5 * kWindow};
}

/// The segments of a map near a place.
LealObserverRow::Detail detailAt(const SegmentMap& map, const Vector<2>& place, double radius) {
  LealObserverRow::Detail detail;
  double length = 0.0;
  for (const Segment& segment : map.segments) {
    if (segment.distance(place) > radius) continue;
    ++detail.segments;
    length += segment.length();
    detail.normal_variance += segment.length() * segment.normal_variance;
  }
  if (length > 0.0) {
    detail.per_metre = detail.segments / length;
    detail.normal_variance /= length;
  }
  return detail;
}

LealObserverRow::Detail meanOf(const std::vector<LealObserverRow::Detail>& details) {
  LealObserverRow::Detail mean;
  const double share = details.empty() ? 0.0 : 1.0 / static_cast<double>(details.size());
  for (const LealObserverRow::Detail& detail : details) {
    mean.segments += share * detail.segments;
    mean.per_metre += share * detail.per_metre;
    mean.normal_variance += share * detail.normal_variance;
  }
  return mean;
}

LealObserverRow walk(const LealData& data, LealMethod method, double threshold) {
  const ViewpointDependentOptions view = dependentOptions(threshold, kObserverLength, kObserverScale);
  SegmentFitter fitter(optionsOf(method, kObserverLength, 1), std::make_shared<ViewpointDependentUtility>(view)),
      invariant_fitter(optionsOf(method, kObserverLength, 1), invariant(method, kObserverLength, threshold));
  for (const LaserScan& scan : data.scans) {
    fitter.add(scan);
    invariant_fitter.add(scan);
  }
  fitter.observe(kOutside);
  const SegmentMap coarse = fitter.map();  // Fig. 9 (a)
  LealObserverRow row;
  row.method = method;
  row.sigma_threshold = threshold;
  row.total_invariant = static_cast<double>(invariant_fitter.map().segments.size());
  row.total_before = static_cast<double>(coarse.segments.size());
  std::vector<LealObserverRow::Detail> at_first, there, after, unvisited;
  std::vector<Vector<2>> visited;
  for (const Vector<2>& place : data.path) {
    fitter.observe(place);
    const SegmentMap map = fitter.map();
    at_first.push_back(detailAt(coarse, place, view.radius));
    there.push_back(detailAt(map, place, view.radius));
    row.elsewhere_before += row.total_before - at_first.back().segments;
    row.elsewhere += static_cast<double>(map.segments.size()) - there.back().segments;
    const auto isLeft = [&](const Vector<2>& old) { return (old - place).norm() >= kAway; };
    for (const Vector<2>& old : visited) {
      if (!isLeft(old)) continue;
      after.push_back(detailAt(map, old, view.radius));
      unvisited.push_back(detailAt(coarse, old, view.radius));
    }
    visited.erase(std::remove_if(visited.begin(), visited.end(), isLeft), visited.end());
    visited.push_back(place);
  }
  fitter.observe(kOutside);
  row.total_after = static_cast<double>(fitter.map().segments.size());
  row.places = data.path.size();
  row.left = after.size();
  row.before = meanOf(at_first);
  row.there = meanOf(there);
  row.after = meanOf(after);
  row.unvisited = meanOf(unvisited);
  row.elsewhere_before /= static_cast<double>(row.places);
  row.elsewhere /= static_cast<double>(row.places);
  return row;
}

/// Returns the walls of a closed hall whose outline has bumps, in pieces of about 0.2 m. The free space is on the left.
std::vector<Segment> roughWalls() {
  constexpr int kPieces = 580;
  const auto corner = [](int i) {
    const double turn = kFullTurn * i / kPieces;
    // Waves of about 4.6, 2.3 and 1.1 m.
    const double bump =
        0.10 * std::sin(25 * turn) + 0.08 * std::sin(51 * turn + 1.0) + 0.05 * std::sin(103 * turn + 2.0);
    // A rounded rectangle (superellipse).
    const double c = std::cos(turn), s = std::sin(turn);
    const double scale = std::pow(std::pow(std::abs(c), 4) + std::pow(std::abs(s), 4), -0.25);
    return Vector<2>((22.0 + bump) * scale * c, (12.0 + bump) * scale * s);
  };
  std::vector<Segment> walls;
  for (int i = 0; i < kPieces; ++i) {
    Segment wall;
    wall.start = corner(i);
    wall.end = corner(i + 1);
    walls.push_back(wall);
  }
  return walls;
}

/// Returns a scan of walls with one beam per half degree over the full turn.
LaserScan rayCast(const std::vector<Segment>& walls, const Pose2& pose, double noise, Random& random) {
  constexpr int kBeams = 720;
  LaserScan scan;
  scan.pose = pose;
  for (int i = 0; i < kBeams; ++i) {
    const double bearing = kFullTurn * ((i + 0.5) / kBeams - 0.5);
    const Vector<2> ray(std::cos(pose.heading + bearing), std::sin(pose.heading + bearing));
    double range = std::numeric_limits<double>::infinity();
    for (const Segment& wall : walls) {
      const Vector<2> along = wall.end - wall.start, to = wall.start - pose.translation;
      const double across = ray.x() * along.y() - ray.y() * along.x();
      const double distance = (to.x() * along.y() - to.y() * along.x()) / across;
      const double share = (to.x() * ray.y() - to.y() * ray.x()) / across;
      if (distance > 0.0 && share >= 0.0 && share <= 1.0) range = std::min(range, distance);
    }
    scan.bearings.push_back(bearing);
    scan.ranges.push_back(range + noise * random.normal());
  }
  return scan;
}

}  // namespace

std::string nameOf(LealMethod method) {
  if (method == LealMethod::AsPrinted) return "as printed";
  return method == LealMethod::Moments ? "moments, eq. (4)" : "default";
}

LealData simulatedPlan(std::uint64_t seed) {
  LealData data;
  data.name = "simulated plan";
  data.scans = scanPlan(kPlanNoise, 0.0, seed);
  data.test = scanPlan(0.0, 0.0, seed);
  data.walls = truePlan();
  data.path = pathOf(data.scans);
  data.window = windowAround(data.scans[data.scans.size() / 2].pose.translation);
  return data;
}

LealData roughHall(std::uint64_t seed) {
  LealData data;
  data.name = "rough hall";
  data.walls = roughWalls();
  Random random(seed);
  for (int i = 0; i < kHallScans; ++i) {
    const double turn = kFullTurn * i / kHallScans, heading = turn + 0.5 * kFullTurn;
    const Pose2 pose{{18.0 * std::cos(turn), 8.5 * std::sin(turn)}, heading};
    data.test.push_back(rayCast(data.walls, pose, 0.0, random));
    data.scans.push_back(rayCast(data.walls, pose, kPlanNoise, random));
  }
  data.path = pathOf(data.scans);
  data.window = windowAround({20.5, 0.0});
  return data;
}

LealData logOf(const std::filesystem::path& folder, const std::string& name) {
  LealData data;
  data.name = name;
  const std::vector<LaserScan> scans = readLogIn(folder);
  data.scans = half(scans, 0);
  data.test = half(scans, 1);
  data.path = pathOf(scans);
  data.window = windowAround(scans[scans.size() / 2].pose.translation);
  return data;
}

std::vector<LealStudyRow> lealStudy(const LealData& data, int seeds) {
  std::vector<LealStudyRow> rows;
  const std::pair<LealMethod, double> methods[] = {{LealMethod::AsPrinted, kDefaultThreshold},
                                                   {LealMethod::AsPrinted, kNoiseThreshold},
                                                   {LealMethod::Moments, kDefaultThreshold},
                                                   {LealMethod::Moments, kNoiseThreshold}};
  for (const auto& [method, threshold] : methods)
    for (const double min_length : {0.3, 0.5, 0.7, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0}) {
      std::vector<LealMeasure> runs;
      const int count = method == LealMethod::AsPrinted ? seeds : 1;
      for (int seed = 1; seed <= count; ++seed)
        runs.push_back(measure(data, method, threshold, min_length, static_cast<std::uint64_t>(seed)));
      rows.push_back({method, min_length, meanOf(runs), threshold});
    }
  constexpr double kNotUsed = std::numeric_limits<double>::quiet_NaN();
  rows.push_back(
      {LealMethod::Default, kNotUsed, measure(data, LealMethod::Default, kDefaultThreshold, 1.0, 1), kNotUsed});
  return rows;
}

std::vector<LealParticleRow> lealParticles(const LealData& data, int seeds) {
  std::vector<LealParticleRow> rows;
  const auto add = [&](int samples, double per_metre, bool in_bins) {
    std::vector<LealMeasure> runs;
    for (int seed = 1; seed <= seeds; ++seed) {
      SegmentFitterOptions options = optionsOf(LealMethod::AsPrinted, 1.0, static_cast<std::uint64_t>(seed));
      options.particles.samples = samples;
      options.particles.per_metre = per_metre;
      if (in_bins) options.particles.limit = ParticleLimit::Bins;
      runs.push_back(measure(data, options, invariant(LealMethod::AsPrinted, 1.0), false));
    }
    rows.push_back({samples, per_metre, in_bins, meanOf(runs)});
  };
  for (const int samples : {3, 10, 30, 100}) add(samples, 300.0, false);
  for (const double per_metre : {100.0, 1000.0, 3000.0}) add(30, per_metre, false);
  add(30, 300.0, true);
  return rows;
}

std::vector<LealExampleRow> lealExample(const LealData& data) {
  std::vector<LealExampleRow> rows;
  const auto add = [&](LealMethod method, double threshold, bool dependent, std::shared_ptr<SegmentUtility> utility) {
    SegmentFitter fitter(optionsOf(method, kExampleLength, 1), std::move(utility));
    for (const LaserScan& scan : data.scans) fitter.add(scan);
    LealExampleRow row;
    row.method = method;
    row.sigma_threshold = threshold;
    row.dependent = dependent;
    row.map = fitter.map();
    row.evidence = fitter.evidence();
    for (const Segment& segment : row.map.segments) {
      if (!isInBox<2>(data.window, 0.5 * (segment.start + segment.end))) continue;
      ++row.segments;
      row.length += segment.length();
      row.normal_variance += segment.length() * segment.normal_variance;
    }
    if (row.length > 0.0) row.normal_variance /= row.length;
    rows.push_back(std::move(row));
  };
  for (const LealMethod method : {LealMethod::AsPrinted, LealMethod::Moments})
    for (const double threshold : {kDefaultThreshold, kNoiseThreshold}) {
      add(method, threshold, false, invariant(method, kExampleLength, threshold));
      ViewpointDependentOptions view = dependentOptions(threshold, kExampleLength, kExampleScale);
      view.viewpoint = 0.5 * (data.window.low + data.window.high);
      view.fixed = true;
      add(method, threshold, true, std::make_shared<ViewpointDependentUtility>(view));
    }
  add(LealMethod::Default, std::numeric_limits<double>::quiet_NaN(), false, {});
  return rows;
}

std::vector<LealObserverRow> lealObserver(const LealData& data) {
  std::vector<LealObserverRow> rows;
  for (const LealMethod method : {LealMethod::AsPrinted, LealMethod::Moments})
    for (const double threshold : {kDefaultThreshold, kNoiseThreshold}) rows.push_back(walk(data, method, threshold));
  return rows;
}

}  // namespace gaussmap::benchmark
