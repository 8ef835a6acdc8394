// SPDX-License-Identifier: BSD-3-Clause
#include "papers/over_time.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/report.h"
#include "core/parallel.h"

namespace gaussmap::papers {
using namespace detail;

namespace {

constexpr std::size_t kSamples = 50000;
constexpr std::size_t kRefineEvery = 10;  // scans, as in the paper
constexpr double kSmallBudget = 3.4;      // 181 / 53 of the paper

/// What is run: the system of the paper with one of three refinements, or the defaults of the library.
struct OnlinePlan {
  std::string method;
  double budget;
  bool is_limited;
};
const std::vector<std::string> kPaperMethods = {"as printed", "with parent seed", "agglomeration"};
constexpr const char* kDefaults = "defaults of the library";

/// The plans after that without refinement.
std::vector<OnlinePlan> plans() {
  std::vector<OnlinePlan> all;
  for (const std::string& method : kPaperMethods)
    for (const bool is_limited : {true, false}) all.push_back({method, 4.0, is_limited});
  all.push_back({kDefaults, 4.0, false});
  return all;
}

OnlineOptions optionsOf(const OnlinePlan& plan, int dimensions) {
  OnlineOptions options = plan.method == kDefaults ? OnlineOptions() : OnlineOptions::yguel2009(dimensions);
  if (plan.method == "with parent seed") options.seed_rule = ClusterSeed::ParentCovariance;
  if (plan.method == "agglomeration") options.method = RefineMethod::Agglomerate;
  if (!plan.is_limited) options.refine_cells = 0;
  options.refine_every = plan.budget == 1.0 ? 0 : static_cast<int>(kRefineEvery);
  options.budget = plan.budget;
  options.threads = 1;
  return options;
}

/// Maps the sequence. `density` = samples per volumeOf() of each scale; empty: kSamples at the end of this run, which
/// is then written to `density`.
template <int D>
OnlineRun runOnce(const Sequence<D>& sequence, const OnlinePlan& plan, int checkpoints, std::vector<double>& density) {
  OnlineOptions options = optionsOf(plan, D);
  options.map = sequence.map;
  OnlineMapper<D> mapper(options);
  OnlineRun run;
  run.method = plan.method;
  run.budget = plan.budget;
  run.is_limited = plan.is_limited;
  const auto scales = static_cast<std::size_t>(options.map.scales);
  run.scale.resize(scales);
  std::vector<GaussianMap<D>> maps;
  std::vector<std::size_t> counts;
  const std::size_t total = sequence.scans.size();
  for (std::size_t i = 0; i < total; ++i) {
    const OnlineStatistics statistics = mapper.add(sequence.scans[i]);
    run.update += statistics.update_time;
    run.occupancy += statistics.image_time + statistics.occupancy_time;
    run.refine += statistics.refine_time;
    const std::size_t next = total * (counts.size() + 1) / static_cast<std::size_t>(checkpoints);
    const bool is_refined = (i + 1) % kRefineEvery == 0;  // a map just before a refinement has cells of new scans
    if (i + 1 < total && (i + 1 < next || !is_refined)) continue;
    counts.push_back(i + 1);
    maps.push_back(mapper.map());
  }
  run.finest = maps.back().gaussianCount(0);
  const bool is_first = density.empty();
  if (is_first) density.assign(scales, 0.0);
  for (std::size_t s = 1; s < scales; ++s) {
    const int scale = static_cast<int>(s);
    if (is_first) density[s] = double(kSamples) / volumeOf(maps.back(), scale);
    for (std::size_t i = 0; i < maps.size(); ++i) {
      const auto growing = static_cast<std::size_t>(std::ceil(density[s] * volumeOf(maps[i], scale)));
      run.scale[s].push_back({counts[i], maps[i].cellCount(scale), maps[i].gaussianCount(scale),
                              distancesOf(maps[i], scale, kSamples, sequence, counts[i]).all,
                              distancesOf(maps[i], scale, growing, sequence, counts[i]).all});
    }
  }
  return run;
}

std::string fourDistances(const DistanceSummary& distances) {
  return number(distances.max) + " / " + number(distances.q99) + " / " + number(distances.q95) + " / " +
         number(distances.mean);
}

void addPlot(const OverTime& results, std::size_t scale, bool is_growing, Report& report) {
  app::LinePlot plot;
  plot.x.title = "scans";
  plot.y = {"distance of samples to the truth [m]", app::AxisScale::Logarithmic};
  const auto add = [&](const OnlineRun& run, int colour) {
    for (const bool is_mean : {false, true}) {
      app::PlotLine line{run.method + (is_mean ? ", mean (dashed)" : ", maximum"), {}, colour, is_mean};
      for (const Checkpoint& point : run.scale[scale]) {
        const DistanceSummary& distances = is_growing ? point.growing : point.fixed;
        line.points.emplace_back(static_cast<double>(point.scans), is_mean ? distances.mean : distances.max);
      }
      plot.lines.push_back(line);
    }
  };
  add(results.runs.front(), 0);
  int colour = 0;
  for (const std::string& method : kPaperMethods) add(runOf(results, method, false), ++colour);
  add(runOf(results, kDefaults, false), ++colour);
  std::string file = results.name + "-scale" + std::to_string(scale) + (is_growing ? "-growing" : "-fixed");
  std::replace(file.begin(), file.end(), ' ', '-');
  report.picture(plot, file,
                 results.name + ", scale " + std::to_string(scale) +
                     ": Hausdorff distance (maximum) and mean over time, at most 4 Gaussians per cell, " +
                     (is_growing ? "samples of a fixed density" : "a fixed number of samples"));
}

}  // namespace

const OnlineRun& runOf(const OverTime& results, const std::string& method, bool is_limited) {
  for (const OnlineRun& run : results.runs)
    if (run.method == method && run.budget == 4.0 && run.is_limited == is_limited) return run;
  throw std::out_of_range("no run of " + method);
}

/// Returns true if 4 more clusters per refinement never reach the budget: the run is then also that of this budget.
bool staysBelow(double budget, const OnlineRun& run) {
  for (std::size_t s = 1; s < run.scale.size(); ++s) {
    std::size_t cells = run.scale[s].front().cells;  // at the checkpoint before
    for (const Checkpoint& point : run.scale[s]) {
      const std::size_t added = 4 * (point.scans / kRefineEvery);
      if (static_cast<double>(added) > (budget - 1.0) * static_cast<double>(cells)) return false;
      cells = point.cells;
    }
  }
  return true;
}

template <int D>
OverTime runOverTime(const Sequence<D>& sequence, int checkpoints) {
  std::vector<double> density;
  OverTime results{sequence.name, D, sequence.map.resolution, sequence.scans.size(), {}};
  results.runs.push_back(runOnce(sequence, {"one per cell", 1.0, false}, checkpoints, density));
  const std::vector<OnlinePlan> all = plans();
  std::vector<std::vector<OnlineRun>> runs(all.size());
  parallelFor(all.size(), 0, 1, [&](std::size_t i) {
    OnlinePlan plan = all[i];
    runs[i].push_back(runOnce(sequence, plan, checkpoints, density));
    if (!plan.is_limited) return;
    plan.budget = kSmallBudget;
    OnlineRun small = staysBelow(plan.budget, runs[i][0]) ? runs[i][0] : runOnce(sequence, plan, checkpoints, density);
    small.budget = plan.budget;
    runs[i].insert(runs[i].begin(), std::move(small));
  });
  for (std::vector<OnlineRun>& more : runs)
    for (OnlineRun& run : more) results.runs.push_back(std::move(run));
  return results;
}

void reportOverTime(const OverTime& results, Report& report) {
  report.heading(3, results.name + ", " + std::to_string(results.dimensions) + "-D, cells of " +
                        number(results.resolution) + " m, " + std::to_string(results.scans) + " scans");
  std::vector<std::vector<std::string>> rows;
  const std::size_t coarsest = results.runs.front().scale.size() - 1;
  for (std::size_t scale = coarsest; scale > 0; --scale)
    for (const OnlineRun& run : results.runs) {
      const Checkpoint& end = run.scale[scale].back();
      const std::string limit = times(run.budget) + (run.is_limited ? ", 4 per refinement" : "");
      std::vector<std::string> row{std::to_string(scale),
                                   run.method,
                                   limit,
                                   std::to_string(end.cells),
                                   std::to_string(end.gaussians),
                                   fourDistances(end.fixed),
                                   fourDistances(end.growing)};
      if (run.is_limited && !rows.empty() && rows.back()[0] == row[0] && rows.back()[1] == row[1] &&
          rows.back()[4] == row[4] && rows.back()[2].find(',') != std::string::npos)
        rows.back()[2] = "3.4 x or 4 x, 4 per refinement";  // too few scans to reach either limit
      else
        rows.push_back(std::move(row));
    }
  report.paragraph("After the last scan. Distances are maximum / 99 % / 95 % / mean [m]:");
  report.table({"scale", "refinement", "limit", "cells", "Gaussians", "fixed number of samples", "fixed density"},
               rows);
  for (const bool is_growing : {false, true}) addPlot(results, coarsest, is_growing, report);
}

template OverTime runOverTime<2>(const Sequence<2>&, int);
template OverTime runOverTime<3>(const Sequence<3>&, int);

}  // namespace gaussmap::papers
