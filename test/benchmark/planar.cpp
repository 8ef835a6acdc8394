// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark planar [--log DIR]: planar maps. Maps scans on line, registers scans to the map of the others, and
// compares the map of a slice of the simulated hall with the map in space, at the walls. DIR has a CARMEN log; without
// DIR, the scans are those of the simulated plan. Prints tables in Markdown. One thread.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "clock.h"
#include "core/about_z.h"
#include "core/quantile.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/registration/registration.h"
#include "segment_data.h"
#include "segments/level_scan.h"
#include "simulation/simulation.h"
#include "simulation/worlds.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
namespace {

const MapOptions kPlanarGrid{0.05, 10, 3, 0.0};

double percentileOf(std::vector<double> values, std::size_t percent) {
  return values.empty() ? 0.0 : detail::percentile(values, percent);
}

/// The share of the finest cells that the on-line map kept, of those that at least `scans` scans have hit.
double keptShare(const GaussianMap<2>& map, const GaussianMap<2>& all, const std::vector<int>& hits, int scans) {
  std::size_t kept = 0, cells = 0;
  for (std::size_t cell = 0; cell < hits.size(); ++cell) {
    if (hits[cell] < scans) continue;
    ++cells;
    kept += map.find(all.scale(0).keys[cell], 0).has_value();
  }
  return static_cast<double>(kept) / static_cast<double>(std::max<std::size_t>(1, cells));
}

void mapOnLine(const std::vector<Scan>& scans) {
  const GaussianMap<2> all = build<2>(MemoryScans(scans), kPlanarGrid);
  std::vector<int> hits(all.cellCount(0), 0), last(all.cellCount(0), -1);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (const Eigen::Vector3d& point : scans[i].points) {
      if (!point.allFinite()) continue;
      const std::size_t cell = *all.find(all.grid().keyOf((scans[i].pose * point).head<2>()), 0);
      if (last[cell] == static_cast<int>(i)) continue;
      last[cell] = static_cast<int>(i);
      ++hits[cell];
    }
  }
  std::printf("| on line | ms per scan | scans per second | cells kept | of those hit by 4 scans or more |\n");
  std::printf("|---|---|---|---|---|\n");
  OnlineOptions own, paper = OnlineOptions::yguel2009(2);
  own.map = paper.map = kPlanarGrid;
  for (OnlineOptions* options : {&own, &paper}) {
    options->threads = 1;
    OnlineMapper<2> mapper(*options);
    const double start = processorSeconds();
    for (const Scan& scan : scans) mapper.add(scan);
    const double seconds = (processorSeconds() - start) / static_cast<double>(scans.size());
    const GaussianMap<2> map = mapper.map();
    std::printf("| %s | %.2f | %.0f | %.1f %% | %.1f %% |\n", options == &own ? "defaults" : "paper", 1e3 * seconds,
                1.0 / seconds, 100.0 * keptShare(map, all, hits, 1), 100.0 * keptShare(map, all, hits, 4));
  }
}

/// Registers every second scan to the map of the others, from random guesses.
void registerScans(const std::vector<Scan>& scans) {
  MemoryScans even;
  for (std::size_t i = 0; i < scans.size(); i += 2) even.add(scans[i]);
  const GaussianMap<2> map = refine<2>(build<2>(even, kPlanarGrid)).map;
  std::printf(
      "\n| guess within | scans | median error | 95 %% | more than 10 cm | median turn | ms per scan |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const auto& [shift, turn] : {std::pair{0.01, 0.01}, {0.2, 0.1}, {0.5, 0.2}}) {
    Random random(1);
    std::vector<double> errors, turns;
    RegistrationOptions options;
    options.threads = 1;
    const double start = processorSeconds();
    for (std::size_t i = 1; i < scans.size(); i += 2) {
      const Pose& truth = scans[i].pose;
      const double heading = 2.0 * std::atan2(truth.rotation.z(), truth.rotation.w());
      const double x = truth.translation.x() + shift * (2.0 * random.uniform() - 1.0);
      const double y = truth.translation.y() + shift * (2.0 * random.uniform() - 1.0);
      const Pose guess{{x, y, 0.0}, detail::aboutZ(heading + turn * (2.0 * random.uniform() - 1.0))};
      const Pose found = registerScan(scans[i].points, map, guess, options).pose;
      errors.push_back((found.translation - truth.translation).norm());
      turns.push_back(Eigen::Quaterniond(found.rotation).angularDistance(Eigen::Quaterniond(truth.rotation)));
    }
    const double seconds = (processorSeconds() - start) / static_cast<double>(std::max<std::size_t>(1, errors.size()));
    const auto far = std::count_if(errors.begin(), errors.end(), [](double error) { return error > 0.1; });
    std::printf("| %.2f m, %.0f deg | %zu | %.3f m | %.3f m | %td | %.2f deg | %.2f |\n", shift, turn * 180.0 / M_PI,
                errors.size(), percentileOf(errors, 50), percentileOf(errors, 95), far,
                percentileOf(turns, 50) * 180.0 / M_PI, 1e3 * seconds);
  }
}

/// Returns the distance of a point [m, map frame] from the walls of the hall: three flat pieces without furniture or
/// doors. Infinity: the point is not near one of them.
double distanceFromWalls(const Vector<3>& point) {
  static const Pose plan = simulation::hallPlacement().inverse();
  const Vector<3> at = plan * point;
  double nearest = std::numeric_limits<double>::infinity();
  if (at.y() > 0.5 && at.y() < 11.5) nearest = std::abs(at.x());
  if ((at.x() > 0.5 && at.x() < 6.5) || (at.x() > 11.0 && at.x() < 17.0)) nearest = std::min(nearest, std::abs(at.y()));
  return nearest < 0.3 ? nearest : std::numeric_limits<double>::infinity();
}

/// Returns the distances of samples of a scale from the walls. In space, only samples in the slice count.
template <int D>
std::vector<double> errorsAtWalls(const GaussianMap<D>& map, int scale, double low, double high) {
  SampleOptions sampling;
  sampling.samples = D == 2 ? 30000 : 300000;
  sampling.threads = 1;
  std::vector<double> errors;
  for (const Vector<D>& point : sampleMap<D>(map, scale, sampling).points) {
    Vector<3> in_space(point.x(), point.y(), low);
    if constexpr (D == 3) in_space.z() = point.z();
    const double error = distanceFromWalls(in_space);
    if (in_space.z() >= low && in_space.z() < high && std::isfinite(error)) errors.push_back(error);
  }
  return errors;
}

void compareSlice() {
  const Simulation simulation = makeSimulation(WorldName::Hall, {20, false});
  MemoryScans scans;
  for (std::size_t i = 0; i < simulation.trajectory.size(); ++i) {
    const SimulatedScan made = simulateScan(simulation, i);
    scans.add({made.points, made.pose, 0, std::nullopt});
  }
  const double low = 1.4, high = 1.7;
  AccumulateOptions slice;
  constexpr double kAnywhere = std::numeric_limits<double>::max();
  slice.crop = Box<3>{{-kAnywhere, -kAnywhere, low}, {kAnywhere, kAnywhere, high}};
  const MapOptions grid{0.1, 10, 3, 0.0};
  const GaussianMap<2> plane = refine<2>(build<2>(scans, grid, slice)).map;
  const GaussianMap<3> space = refine<3>(build<3>(scans, grid)).map;
  std::printf("\n| walls of the hall | 2-D mean | 2-D 95 %% | 3-D mean | 3-D 95 %% |\n|---|---|---|---|---|\n");
  for (int scale = 0; scale < grid.scales; ++scale) {
    const DistanceSummary flat = summarise(errorsAtWalls(plane, scale, low, high)),
                          whole = summarise(errorsAtWalls(space, scale, low, high));
    std::printf("| scale %d | %.4f m | %.4f m | %.4f m | %.4f m |\n", scale, flat.mean, flat.q95, whole.mean,
                whole.q95);
  }
}

}  // namespace

void addPlanar(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  CLI::App& command = *app.add_subcommand("planar", "planar maps: on line, registration, and a slice of a hall");
  command.add_option("--log", *folder, "directory with a CARMEN log")->check(CLI::ExistingDirectory);
  command.callback([folder] {
    std::vector<Scan> scans;
    for (const LaserScan& sweep : folder->empty() ? scanPlan(0.01, 0.0, 1) : readLogIn(*folder))
      scans.push_back(detail::scanOfBeams(sweep));
    mapOnLine(scans);
    registerScans(scans);
    compareSlice();
  });
}

}  // namespace gaussmap::benchmark
