// SPDX-License-Identifier: BSD-3-Clause
#include "papers/off_line.h"

#include <algorithm>
#include <stdexcept>

#include "core/parallel.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "uniform_grid.h"

namespace gaussmap::papers {
using namespace detail;

namespace {

constexpr std::size_t kSamples = 50000;
constexpr double kStall = 0.99;  // a round stalls if more than this share of the maximum is left
const std::vector<double> kBudgets = {1.0, 1.5, 2.0, 3.0, 3.4, 4.0};
constexpr const char* kUniformGrid = "uniform grid";

struct OffLineMethod {
  std::string name;
  RefineOptions options;
};

std::vector<OffLineMethod> offLineMethods() {
  OffLineMethod printed{"as printed", RefineOptions::yguel2009()}, parent{"with parent seed", printed.options};
  parent.options.seed_rule = ClusterSeed::ParentCovariance;
  std::vector<OffLineMethod> methods{printed, parent, {"agglomeration", RefineOptions()}};
  for (OffLineMethod& method : methods) method.options.threads = 1;
  return methods;
}

/// Counts the rounds that do not help. The finer scales keep one Gaussian per cell, so that each round changes the
/// coarsest scale only.
template <int D>
StallRow stallsOf(const OffLineMethod& method, const GaussianMap<D>& one, const Sequence<D>& sequence) {
  const int coarsest = one.scales() - 1;
  const std::size_t cells = one.cellCount(coarsest);
  MaxGaussians limit;
  for (int scale = 1; scale <= coarsest; ++scale) limit.by_scale[scale] = one.cellCount(scale);
  StallRow row{method.name};
  double before = distancesOf(one, coarsest, kSamples, sequence, sequence.scans.size()).all.max;
  const std::size_t step = std::max<std::size_t>(4, 3 * cells / 50 / 4 * 4);  // at most about 50 rounds
  for (std::size_t more = step; more <= 3 * cells; more += step) {
    limit.by_scale[coarsest] = cells + more;
    const GaussianMap<D> map = refine<D>(one, limit, method.options).map;
    const double now = distancesOf(map, coarsest, kSamples, sequence, sequence.scans.size()).all.max;
    ++row.rounds;
    row.stalled += now > kStall * before;
    before = now;
  }
  return row;
}

GaussianMap<3> gridOf(const Sequence<3>& sequence, std::size_t most, double widest) {
  return refinement::uniformGrid(sequence.points(sequence.scans.size()), most, widest, sequence.map.resolution);
}

}  // namespace

template <int D>
OffLine runOffLine(const Sequence<D>& sequence) {
  const GaussianMap<D> one = build<D>(MemoryScans(sequence.scans), sequence.map);
  const int coarsest = one.scales() - 1;
  const std::vector<OffLineMethod> methods = offLineMethods();
  OffLine results{sequence.name, D, one.gaussianCount(0), {}, {}};
  results.rows.resize(methods.size() * kBudgets.size());
  results.stalls.resize(methods.size());
  const auto measure = [&](const GaussianMap<D>& map, int scale) {
    return distancesOf(map, scale, kSamples, sequence, sequence.scans.size());
  };
  parallelFor(results.rows.size() + methods.size(), 0, 1, [&](std::size_t i) {
    if (i < methods.size()) {
      results.stalls[i] = stallsOf(methods[i], one, sequence);
      return;
    }
    i -= methods.size();
    const OffLineMethod& method = methods[i / kBudgets.size()];
    const double budget = kBudgets[i % kBudgets.size()];
    const GaussianMap<D> map = refine<D>(one, PerCell{budget}, method.options).map;
    const SampleDistances distances = measure(map, coarsest);
    results.rows[i] = {method.name, budget, map.gaussianCount(coarsest), distances.all, distances.within_two_sigma};
  });
  if constexpr (D == 3) {
    for (const double budget : {3.4, 4.0}) {
      const auto most = static_cast<std::size_t>(budget * double(one.cellCount(coarsest)));
      const GaussianMap<3> grid = gridOf(sequence, most, one.grid().side(coarsest));
      const SampleDistances distances = measure(grid, 1);
      results.rows.push_back({kUniformGrid, budget, grid.gaussianCount(1), distances.all, distances.within_two_sigma});
    }
  }
  return results;
}

const RefinedRow& rowOf(const OffLine& results, const std::string& method, double budget) {
  for (const RefinedRow& row : results.rows)
    if (row.method == method && row.budget == budget) return row;
  throw std::out_of_range("no row of " + method);
}

void reportOffLine(const OffLine& results, Report& report) {
  report.heading(3, results.name + ", " + std::to_string(results.dimensions) + "-D");
  std::vector<std::vector<std::string>> rows;
  app::LinePlot plot;
  plot.x = {"Gaussians of the coarsest scale", app::AxisScale::Linear};
  plot.y = {"distance of samples to the truth [m]", app::AxisScale::Logarithmic};
  std::string method;
  for (const RefinedRow& row : results.rows) {
    const DistanceSummary& to = row.distances;
    rows.push_back({row.method, times(row.budget), std::to_string(row.gaussians), number(to.max),
                    number(row.within_two_sigma), number(to.q99), number(to.q95), number(to.mean)});
    if (row.method == kUniformGrid) continue;
    if (row.method != method) {
      const int colour = static_cast<int>(plot.lines.size() / 2) + 1;
      plot.lines.push_back({row.method + ", maximum", {}, colour, false});
      plot.lines.push_back({row.method + ", mean (dashed)", {}, colour, true});
      method = row.method;
    }
    plot.lines[plot.lines.size() - 2].points.emplace_back(static_cast<double>(row.gaussians), to.max);
    plot.lines.back().points.emplace_back(static_cast<double>(row.gaussians), to.mean);
  }
  report.table({"refinement", "limit", "Gaussians", "maximum [m]", "maximum within 2 sigma", "99 %", "95 %", "mean"},
               rows);
  std::string file = results.name + "-off-line";
  std::replace(file.begin(), file.end(), ' ', '-');
  report.picture(plot, file, results.name + ": the coarsest scale, refined off line");
}

template OffLine runOffLine<2>(const Sequence<2>&);
template OffLine runOffLine<3>(const Sequence<3>&);

}  // namespace gaussmap::papers
