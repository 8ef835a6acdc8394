// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark segments [--data DIR] [--seeds 3] [--study]: compares maps of line segments with common methods,
// and repeats the study of Leal, Scheding, Dissanayake 2000. DIR has the directories carmen_intel and carmen_csail with
// one log each. Without DIR only the simulated plan is scanned. Prints tables in Markdown. One thread.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>

#include "clock.h"
#include "evaluation/segment_score.h"
#include "evaluation/wall_score.h"
#include "gaussmap/segments/segment_fitter.h"
#include "papers_leal.h"
#include "segment_baselines.h"
#include "segment_data.h"
#include "subcommands.h"
#include "table.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

constexpr std::size_t kMaxSegments = 500;
constexpr double kRangeNoise = 0.02, kPositionNoise = 0.02;  // noise of the simulated plan [m]
constexpr int kRuns = 5;                                     // number of runs, of which the fastest counts

using Scans = std::vector<LaserScan>;
using Method = std::function<SegmentMap(const Scans&)>;

SegmentFitterOptions policy(EvidencePolicy policy, std::uint64_t seed = 1) {
  SegmentFitterOptions options;
  options.policy = policy;
  options.particles.seed = seed;
  return options;
}

SegmentFitterOptions leal2000(std::uint64_t seed = 1) {
  SegmentFitterOptions options = SegmentFitterOptions::leal2000();
  options.particles.seed = seed;
  return options;
}

SegmentMap fitMap(const Scans& scans, const SegmentFitterOptions& options,
                  const std::shared_ptr<SegmentUtility>& utility = {}) {
  SegmentFitter fitter(options, utility);
  for (const LaserScan& scan : scans) fitter.add(scan);
  return fitter.map();
}

void holdOut(const Scans& scans) {
  const Scans even = half(scans, 0), odd = half(scans, 1);
  std::printf("| %-36s | segments | cov5 | cov10 | rms [m] | length [m] | r10 | viol |\n",
              "even scans map, odd scans test");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  const auto row = [&](const char* name, const SegmentMap& map) {
    const HoldOutScore score = scoreHoldOut(map, odd);
    std::printf("| %-36s | %4zu | %.3f | %.3f | %.4f | %5.1f | %.3f | %.3f |\n", name, map.segments.size(),
                score.within_5cm, score.within_10cm, score.rms, map.totalLength(), score.predicted_10cm,
                score.blocked_early);
    std::fflush(stdout);
  };
  const SegmentMap ours = fitMap(even, policy(EvidencePolicy::MomentCells));
  const std::size_t count = std::min(ours.segments.size(), kMaxSegments);
  row("moments", ours);
  row("particles", fitMap(even, policy(EvidencePolicy::ParticleSets)));
  row("the paper, literal", fitMap(even, leal2000(), std::make_shared<ViewpointInvariantUtility>()));
  row("iterative end-point fit", endPointFit(even, count));
  row("RANSAC + total least squares", ransac(even, count));
  std::printf("\n");
}

/// Prints means over the seeds.
void plan(double position_noise, int seeds) {
  std::printf(
      "| plan, ranges +- %.0f cm, poses +- %.0f cm | segments | recall 5 cm | recall 2 cm | precision 5 cm | offset "
      "[mm] | angle [deg] | corners [cm] | NEES |\n|---|---|---|---|---|---|---|---|---|\n",
      100.0 * kRangeNoise, 100.0 * position_noise);
  const std::vector<Segment> walls = truePlan();
  const auto row = [&](const char* name, bool has_covariance,
                       const std::function<SegmentMap(const Scans&, std::uint64_t)>& make) {
    double count = 0, recall = 0, recall2 = 0, precision = 0, offset = 0, angle = 0, corner = 0, nees = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const auto number = static_cast<std::uint64_t>(seed);
      const SegmentMap map = make(scanPlan(kRangeNoise, position_noise, number), number);
      const WallScore score = scoreWalls(map, walls);
      WallScoreOptions strict;
      strict.tolerance = 0.02;
      count += static_cast<double>(map.segments.size());
      recall += score.recall;
      recall2 += scoreWalls(map, walls, strict).recall;
      precision += score.precision;
      offset += 1000.0 * score.offset_rms;
      angle += score.angle_rms * 180.0 / std::acos(-1.0);
      corner += 100.0 * score.corner_median;
      nees += score.normalised_error;
    }
    const double n = seeds;
    std::printf("| %-24s | %.0f | %.4f | %.4f | %.4f | %.2f | %.3f | %.2f | ", name, count / n, recall / n, recall2 / n,
                precision / n, offset / n, angle / n, corner / n);
    std::printf(has_covariance ? "%.2f |\n" : "- |\n", nees / n);
    std::fflush(stdout);
  };
  row("moments", true,
      [](const Scans& scans, std::uint64_t seed) { return fitMap(scans, policy(EvidencePolicy::MomentCells, seed)); });
  row("particles", true,
      [](const Scans& scans, std::uint64_t seed) { return fitMap(scans, policy(EvidencePolicy::ParticleSets, seed)); });
  row("iterative end-point fit", false,
      [](const Scans& scans, std::uint64_t) { return endPointFit(scans, kMaxSegments); });
  std::printf("\n");
}

/// Measures beams per second: scan by scan, and including the map at the end.
void speed(const char* name, const Scans& scans, Table& table) {
  std::size_t beams = 0;
  for (const LaserScan& scan : scans)
    for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) beams += scan.returned(beam);
  const auto rate = [&](double seconds) { return static_cast<double>(beams) / seconds / 1e6; };
  double baseline = 1e300;
  for (int run = 0; run < kRuns; ++run) {
    const double start = processorSeconds();
    endPointFit(scans, kMaxSegments);
    baseline = std::min(baseline, processorSeconds() - start);
  }
  std::printf(
      "| all scans, %zu beams | M beams/s | with the map | end-point fit's time / ours | memory [MB] "
      "|\n|---|---|---|---|---|\n",
      beams);
  for (const EvidencePolicy kind : {EvidencePolicy::MomentCells, EvidencePolicy::ParticleSets}) {
    double adding = 1e300, all = 1e300;
    std::size_t memory = 0;
    for (int run = 0; run < kRuns; ++run) {
      const double start = processorSeconds();
      SegmentFitter fitter(policy(kind));
      for (const LaserScan& scan : scans) fitter.add(scan);
      adding = std::min(adding, processorSeconds() - start);
      fitter.map();
      all = std::min(all, processorSeconds() - start);
      memory = fitter.memoryBytes();
    }
    std::printf("| %s | %.2f | %.2f | %.2f | %.1f |\n", kind == EvidencePolicy::MomentCells ? "moments" : "particles",
                rate(adding), rate(all), baseline / adding, static_cast<double>(memory) / 1e6);
    if (kind == EvidencePolicy::MomentCells)
      table.rows.push_back(Row{"segments", std::string(name) + ", " + std::to_string(beams) + " beams", 1, adding,
                               static_cast<double>(memory) / 1e6, "iterative end-point fit", baseline, 0.0});
  }
  std::printf("| iterative end-point fit | | %.2f | 1 | |\n\n", rate(baseline));
}

void run(const std::string& data, int seeds, bool only_speed, Table& table) {
  if (data.empty()) speed("floor plan", scanPlan(0.01, 0.0, 1), table);
  if (only_speed && data.empty()) return;
  if (only_speed) return speed("Intel lab", readLogIn(std::filesystem::path(data) / "carmen_intel"), table);
  for (const double noise : {0.0, kPositionNoise}) plan(noise, seeds);
  if (data.empty()) return;
  const Scans intel = readLogIn(std::filesystem::path(data) / "carmen_intel");
  std::printf("carmen_intel\n\n");
  holdOut(intel);
  speed("Intel lab", intel, table);
  printLeal(logOf(std::filesystem::path(data) / "carmen_intel", "carmen_intel"), seeds);
  printLeal(logOf(std::filesystem::path(data) / "carmen_csail", "carmen_csail"), seeds);
}

/// Only the experiments of the paper: on simulated scans, and on the Intel lab if there are data.
void runStudy(const std::string& data, int seeds) {
  printLeal(simulatedPlan(), seeds);
  printLeal(roughHall(), seeds);
  if (!data.empty()) printLeal(logOf(std::filesystem::path(data) / "carmen_intel", "Intel lab"), seeds);
}

}  // namespace

void addSegments(CLI::App& app) {
  struct Given {
    std::string data, json;
    int seeds = 3;
    bool only_speed = false, study = false;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("segments", "maps of line segments: accuracy, speed, and the paper's study");
  command.add_option("--data", given->data, "directory with carmen_intel and carmen_csail")
      ->check(CLI::ExistingDirectory);
  command.add_option("--seeds", given->seeds, "of the simulated noise and of particles")->check(CLI::Range(1, 1000));
  command.add_flag("--only-speed", given->only_speed, "only the speed, in beams per second");
  command.add_flag("--study", given->study, "only the experiments of the paper");
  command.add_option("--json", given->json, "write the speed for machines");
  command.callback([given] {
    if (given->study) return runStudy(given->data, given->seeds);
    Table table;
    run(given->data, given->seeds, given->only_speed, table);
    if (!given->json.empty()) writeJson(given->json, table);
  });
}

}  // namespace gaussmap::benchmark
