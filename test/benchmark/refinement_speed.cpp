// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark refinement-speed [--scans 0] [--runs 5] [--json FILE]: measures the seconds of agglomerative
// refinement on the simulated street with one thread: for the coarsest scale, and for a middle scale of about 250,000
// finest Gaussians. Also compares the clustering alone with scalar code with logarithms on the same input. Prints the
// shortest of the runs, which take turns.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>

#include "clock.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/coarsen.h"
#include "mapping/clustering_noise.h"
#include "refinement_data.h"
#include "scalar_agglomerate.h"
#include "subcommands.h"
#include "table.h"

namespace gaussmap::refinement {
using namespace detail;

namespace {

constexpr double kFinest = 250000.0;  // Gaussians under the middle scale
constexpr double kBudget = 3.4;

template <typename Work>
double seconds(const Work& work) {
  const double start = benchmark::wallSeconds();
  work();
  return benchmark::wallSeconds() - start;
}

/// The input of the refinement of one coarse cell.
struct CellData {
  std::vector<Gaussian<3>> gaussians;
  std::vector<double> areas;
};

/// Returns the input that refine() clusters: blurred Gaussians, and their numbers of occupied finest cells.
std::vector<CellData> dataOf(const GaussianMap<3>& map, int coarse) {
  std::vector<double> areas(map.gaussianCount(0), 1.0);
  for (int s = 0; s + 1 < coarse; ++s) {
    std::vector<double> coarser(map.gaussianCount(s + 1), 0.0);
    for (std::size_t i = 0; i < areas.size(); ++i) coarser[map.parentOf(i, s)] += areas[i];
    areas = std::move(coarser);
  }
  std::vector<CellData> cells(map.cellCount(coarse));
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    gatherUnder<3>(map.scale(coarse - 1), map.grid(), coarse - 1, map.childCells(cell, coarse), cells[cell].gaussians);
    addClusteringNoise(cells[cell].gaussians, map.grid().side(0));
    const IndexRange under = map.gaussiansUnder(cell, coarse);
    for (std::size_t i = under.first; i < under.last; ++i) cells[cell].areas.push_back(areas[i]);
  }
  return cells;
}

struct Times {
  double whole = std::numeric_limits<double>::infinity();
  double clustering = std::numeric_limits<double>::infinity();
  double scalar = std::numeric_limits<double>::infinity();
};

/// Measures the clustering of cells with the library's code and with scalar code.
void timeClustering(const std::vector<CellData>& cells, Times& times) {
  std::size_t merges = 0;  // used, so that no call is optimised away
  times.clustering = std::min(times.clustering, seconds([&] {
                                for (const CellData& cell : cells)
                                  merges += agglomerate(cell.gaussians, cell.areas).merges.size();
                              }));
  times.scalar = std::min(times.scalar, seconds([&] {
                            for (const CellData& cell : cells)
                              merges += scalarAgglomerate(cell.gaussians).merges.size();
                          }));
  if (merges == 0) throw std::logic_error("nothing was clustered");
}

/// Checks that the scalar code gives the same summed cost as the library with the same cost function.
void checkScalar(const std::vector<CellData>& cells) {
  AgglomerateOptions options;
  options.cost = MergeCost::Runnalls;
  for (const CellData& cell : cells) {
    if (cell.gaussians.size() > options.max_exact) continue;
    const auto sum = [](const Dendrogram& dendrogram) {
      double costs = 0.0;
      for (const Dendrogram::Merge& merge : dendrogram.merges) costs += merge.cost;
      return costs;
    };
    const double ours = sum(agglomerate(cell.gaussians, cell.areas, options));
    const double theirs = sum(scalarAgglomerate(cell.gaussians));
    if (!(std::abs(ours - theirs) <= 1e-6 * (1.0 + std::abs(ours))))
      throw std::logic_error("the scalar code clusters in another way");
  }
}

RefineOptions oneThread() {
  RefineOptions options;
  options.threads = 1;
  return options;
}

/// Builds a map of so many of the first points that they fill about kFinest cells.
GaussianMap<3> quarterMillion(const std::vector<Vector<3>>& points, std::size_t cells) {
  const double share = std::min(1.0, kFinest / static_cast<double>(cells));
  // The number of cells grows almost in proportion to the points along the way, so two corrections are enough.
  auto count = static_cast<std::size_t>(share * static_cast<double>(points.size()));
  GaussianMap<3> map({0.1, 10, 2});
  for (int step = 0; step < 3; ++step) {
    map = build<3>({points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count)}, {0.1, 10, 2});
    if (share == 1.0) break;
    const double next = static_cast<double>(count) * kFinest / static_cast<double>(map.cellCount(0));
    if (step < 2) count = std::min(points.size(), static_cast<std::size_t>(next));
  }
  return map;
}

/// Reports the clustering beside the scalar code, and the whole refinement.
void report(const char* scale, std::size_t cells, std::size_t data, const Times& times, benchmark::Table& table) {
  const std::string input =
      std::string(scale) + ", " + std::to_string(data) + " Gaussians in " + std::to_string(cells) + " cells";
  table.add(benchmark::Row{"clustering", input, 1, times.clustering, 0.0, "scalar code", times.scalar, 0.0});
  table.add(benchmark::Figure{"refinement", input, "whole", "s", times.whole});
}

void run(int scans, int runs, const std::string& json) {
  SimulationOptions street;
  street.scans = scans;
  const std::vector<Vector<3>> points = simulatedDrive(makeSimulation(WorldName::Street, street), 1).points;
  const GaussianMap<3> one = build<3>(points, {0.1, 10, 3});
  const GaussianMap<3> middle = quarterMillion(points, one.cellCount(0));
  const PerCell budget{kBudget};
  const MaxGaussians without_coarsest{
      {{1, static_cast<std::size_t>(kBudget * static_cast<double>(one.cellCount(1)))}, {2, one.cellCount(2)}}};
  const std::vector<CellData> coarsest_data = dataOf(refine<3>(one, budget, oneThread()).map, 2),
                              middle_data = dataOf(middle, 1);

  checkScalar(coarsest_data);
  checkScalar(middle_data);

  Times coarsest_times, middle_times;
  double both = std::numeric_limits<double>::infinity(), below = both;
  for (int i = 0; i < runs; ++i) {
    both = std::min(both, seconds([&] { refine<3>(one, budget, oneThread()); }));
    below = std::min(below, seconds([&] { refine<3>(one, without_coarsest, oneThread()); }));
    middle_times.whole = std::min(middle_times.whole, seconds([&] { refine<3>(middle, budget, oneThread()); }));
    timeClustering(coarsest_data, coarsest_times);
    timeClustering(middle_data, middle_times);
  }
  coarsest_times.whole = both - below;

  std::size_t data = 0;
  for (const CellData& cell : coarsest_data) data += cell.gaussians.size();
  benchmark::Table table;
  report("coarsest, 10 m", one.cellCount(2), data, coarsest_times, table);
  report("middle, 1 m", middle.cellCount(1), middle.cellCount(0), middle_times, table);
  if (!json.empty()) benchmark::writeJson(json, table);
}

}  // namespace
}  // namespace gaussmap::refinement

namespace gaussmap::benchmark {

void addRefinementSpeed(CLI::App& app) {
  struct Given {
    int scans = 0, runs = 5;
    std::string json;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("refinement-speed", "seconds of agglomerative refinement");
  command.add_option("--scans", given->scans, "of the street; 0: as many as it has")->check(CLI::Range(0, 1000));
  command.add_option("--runs", given->runs, "the shortest counts")->check(CLI::Range(1, 1000))->capture_default_str();
  command.add_option("--json", given->json, "write the figures for machines");
  command.callback([given] { refinement::run(given->scans, given->runs, given->json); });
}

}  // namespace gaussmap::benchmark
