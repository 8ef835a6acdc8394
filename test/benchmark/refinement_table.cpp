// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark refinement-table [--data DIR] [--seeds 3] [--scans 0] [--json FILE]: measures how far samples of
// the coarsest scale lie from the data at equal numbers of Gaussians: for the refinements of gaussmap, one Gaussian per
// cell and a uniform grid. The seeds are those of the simulated noise, the random method and the sampling.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "mesh/mesh_distance.h"
#include "refinement_report.h"
#include "subcommands.h"
#include "uniform_grid.h"

namespace gaussmap::refinement {
using namespace detail;

namespace {

/// The truth of one seed, prepared for measuring maps.
class Meter {
 public:
  Meter(const LoadedData& data, std::uint64_t seed) : truth_(data.truth) {
    options_.seed = seed;
    if (data.hits.empty()) return;
    hits_.emplace(data.hits);
    mesh_.emplace(data.mesh);
  }

  Run measure(const GaussianMap<3>& map, int scale, std::size_t at_least = SampleOptions().at_least) const {
    SampleOptions options = options_;
    options.at_least = at_least;
    const std::vector<Vector<3>> samples = sampleMap(map, scale, options).points;
    const HausdorffResult both = truth_.compare(samples);
    Run run{map.gaussianCount(scale), both.forward, both.backward, {}, {}};
    if (mesh_) run.to_mesh = summarise(meshDistances(samples, *mesh_));
    if (hits_) run.to_hits = hits_->compare(samples).forward;
    return run;
  }

 private:
  SampleOptions options_;
  Reference truth_;
  std::optional<Reference> hits_;
  std::optional<MeshDistance> mesh_;
};

/// Returns the options of Algorithm 2 with its queue.
RefineOptions paper(ClusterSeed seed_rule, std::uint64_t seed) {
  RefineOptions options;
  options.method = RefineMethod::Insert;
  options.seed_rule = seed_rule;
  options.seed = seed;
  return options;
}

void addSeed(Table& table, std::uint64_t seed) {
  const LoadedData data = table.data->load(seed);
  const Meter meter(data, seed);
  const MapOptions& options = table.data->options;
  const int coarsest = options.scales - 1;
  const GaussianMap<3> one = build<3>(data.points, options);
  table.row(1.0, kOnePerCell).runs.push_back(meter.measure(one, coarsest));
  for (const double budget : table.data->budgets) {
    const auto measure = [&](const char* method, const RefineOptions& with) {
      const Run run = meter.measure(refine<3>(one, PerCell{budget}, with).map, coarsest);
      table.row(budget, method).runs.push_back(run);
      return run.gaussians;
    };
    measure(kPaper, paper(ClusterSeed::InputGaussian, seed));
    measure(kParentSeed, paper(ClusterSeed::ParentCovariance, seed));
    const std::size_t most = measure(kAgglomeration, RefineOptions());
    const GaussianMap<3> uniform = uniformGrid(data.points, most, one.grid().side(coarsest), options.resolution);
    table.row(budget, kUniformGrid).runs.push_back(meter.measure(uniform, 1));
  }
  if (!table.data->simulated) return;
  table.middle.runs.push_back(meter.measure(refine<3>(one, PerCell{table.middle.budget}).map, 1));
  // At these scales the minimum number of samples decides, not the volume. With fewer samples for the many finest
  // Gaussians, the figures are the same and take a tenth of the time.
  table.finest.runs.push_back(meter.measure(one, 0, 3));
}

/// Returns the distance of another method as a multiple of that of agglomeration.
Ratio timesAgglomeration(Table& table, const char* name, double DistanceSummary::*quantity,
                         DistanceSummary Run::*summary, double budget, const Row& other) {
  const auto value = [=](const Run& run) { return run.*summary.*quantity; };
  char text[120];
  std::snprintf(text, sizeof text, "%s, %s / agglomeration at %g x", name, other.method.c_str(), budget);
  return {text, figure(other, value).mean / figure(table.row(budget, kAgglomeration), value).mean};
}

std::vector<Ratio> ratiosOf(Table& table) {
  std::vector<Ratio> ratios;
  const auto add = [&](const char* name, double DistanceSummary::*quantity, DistanceSummary Run::*summary,
                       double budget, const Row& other) {
    ratios.push_back(timesAgglomeration(table, name, quantity, summary, budget, other));
  };
  if (!table.data->simulated) {
    const Row one = table.row(1.0, kOnePerCell);
    add("99 %", &DistanceSummary::q99, &Run::to_truth, 4.0, one);
    add("95 %", &DistanceSummary::q95, &Run::to_truth, 4.0, one);
    add("mean", &DistanceSummary::mean, &Run::to_truth, 4.0, one);
    return ratios;
  }
  const Row other = table.row(3.4, kPaper);
  for (const auto summary : {&Run::to_truth, &Run::to_hits}) {
    const std::size_t first = ratios.size();
    add("99 %", &DistanceSummary::q99, summary, 3.4, other);
    add("95 %", &DistanceSummary::q95, summary, 3.4, other);
    add("mean", &DistanceSummary::mean, summary, 3.4, other);
    const auto mean = [=](const Run& run) { return (run.*summary).mean; };
    ratios.push_back({"mean, middle scale at 2 x / finest scale",
                      figure(table.middle, mean).mean / figure(table.finest, mean).mean});
    if (summary == &Run::to_hits)
      for (std::size_t i = first; i < ratios.size(); ++i) ratios[i].text += ", to the rays' ends";
  }
  return ratios;
}

struct Options {
  std::string data, json;
  int seeds = 3, scans = 0;
  double spacing = kTruthSpacing;
};

void run(const Options& options) {
  const std::vector<DataSet> sets = dataSets(options.data, options.scans, options.spacing);
  std::vector<Table> tables;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const DataSet& set : sets) {
    Table table;
    table.data = &set;
    for (int seed = 1; seed <= options.seeds; ++seed) addSeed(table, static_cast<std::uint64_t>(seed));
    const std::vector<Ratio> ratios = ratiosOf(table);
    printTable(table, ratios);
    json.push_back(toJson(table, ratios));
    tables.push_back(std::move(table));
  }
  std::printf("### Overview\n\n");
  printOverview(tables);
  if (!options.json.empty() && !(std::ofstream(options.json) << json.dump(2) << '\n'))
    throw std::runtime_error(options.json + ": cannot be written");
}

}  // namespace
}  // namespace gaussmap::refinement

namespace gaussmap::benchmark {

void addRefinementTable(CLI::App& app) {
  const auto options = std::make_shared<refinement::Options>();
  CLI::App& command = *app.add_subcommand("refinement-table", "refinement at equal numbers of Gaussians");
  command.add_option("--data", options->data, "folder with kitti_6scans, rgbd_office_single, octomap_geb079")
      ->check(CLI::ExistingDirectory);
  command.add_option("--seeds", options->seeds, "of every figure")->check(CLI::Range(1, 1000))->capture_default_str();
  command.add_option("--scans", options->scans, "of the streets; 0: as many as they have")->check(CLI::Range(0, 1000));
  command.add_option("--spacing", options->spacing, "of the points on the simulated surfaces [m]")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command.add_option("--json", options->json, "file to write all figures of all seeds to");
  command.callback([options] { refinement::run(*options); });
}

}  // namespace gaussmap::benchmark
