// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark distances [--data DIR] [--scans 0] [--runs 1]: refines maps by insertion with every distance
// between Gaussians and every rule for new clusters, at equal numbers of Gaussians. Prints two Markdown tables. DIR has
// kitti_6scans, rgbd_office_single and carmen_intel.
#include "clustering_distances.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>

#include "clock.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "mesh/mesh_distance.h"
#include "refinement_data.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
namespace {

namespace fs = std::filesystem;

struct NamedDistance {
  GaussianDistance distance;
  const char* name;
};
constexpr NamedDistance kDistances[] = {{GaussianDistance::KL, "KL"},
                                        {GaussianDistance::SymmetricKL, "symmetric KL"},
                                        {GaussianDistance::Bhattacharyya, "Bhattacharyya"},
                                        {GaussianDistance::Wasserstein, "Wasserstein"}};
constexpr ClusterSeed kSeeds[] = {ClusterSeed::ParentCovariance, ClusterSeed::InputGaussian};

const char* nameOf(GaussianDistance distance) {
  for (const NamedDistance& named : kDistances)
    if (named.distance == distance) return named.name;
  return "?";
}

const char* nameOf(ClusterSeed seed) {
  return seed == ClusterSeed::ParentCovariance ? "parent" : "as in the paper";
}

/// Returns the mean of KL(finest Gaussian || its ancestor at a scale), weighted with the numbers of points [nat].
template <int D>
double distortionOf(const GaussianMap<D>& map, int scale) {
  double sum = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) {
    std::size_t ancestor = i;
    for (int s = 0; s < scale; ++s) ancestor = map.parentOf(ancestor, s);
    const Gaussian<D> finest = map.gaussian(i, 0);
    sum += finest.weight * klDivergence(finest, map.gaussian(ancestor, scale));
    weight += finest.weight;
  }
  return sum / weight;
}

/// Returns the distances of points from the reference of a data set.
template <int D>
using Meter = std::function<DistanceSummary(const std::vector<Vector<D>>& points)>;

template <int D>
Meter<D> meterOf(const std::vector<Vector<D>>& points) {
  return [reference = Reference(points)](const std::vector<Vector<D>>& samples) {
    return reference.compare(samples).forward;
  };
}

template <int D>
void addRows(const std::string& name, const GaussianMap<D>& map, const Meter<D>& meter,
             const ClusteringDistanceOptions& options, std::vector<ClusteringDistanceRow>& rows) {
  SampleOptions sampling;
  sampling.samples = 50000;
  sampling.at_least = 5;
  for (const ClusterSeed seed_rule : kSeeds)
    for (const double budget : options.budgets) {
      std::vector<std::vector<double>> seconds(std::size(kDistances));
      std::vector<std::optional<GaussianMap<D>>> results(std::size(kDistances));
      for (int run = 0; run < options.runs; ++run)
        for (std::size_t d = 0; d < std::size(kDistances); ++d) {
          RefineOptions refinement;
          refinement.method = RefineMethod::Insert;
          refinement.seed_rule = seed_rule;
          refinement.distance = kDistances[d].distance;
          refinement.threads = 1;
          const double start = processorSeconds();
          results[d] = refine<D>(map, PerCell{budget}, refinement).map;
          seconds[d].push_back(processorSeconds() - start);
        }
      for (std::size_t d = 0; d < std::size(kDistances); ++d) {
        std::sort(seconds[d].begin(), seconds[d].end());
        for (int scale = 1; scale < map.scales(); ++scale) {
          const GaussianMap<D>& refined = *results[d];
          rows.push_back({name, scale, budget, kDistances[d].distance, seed_rule, refined.gaussianCount(scale),
                          distortionOf(refined, scale), meter(sampleMap(refined, scale, sampling).points),
                          seconds[d][seconds[d].size() / 2]});
        }
      }
    }
}

/// A simulated world. The reference is its surface, and distances from it are exact.
void addSimulated(const std::string& name, WorldName world, int scans, const MapOptions& map,
                  const ClusteringDistanceOptions& options, std::vector<ClusteringDistanceRow>& rows) {
  SimulationOptions simulation;
  simulation.scans = options.scans == 0 ? scans : options.scans;
  const refinement::LoadedData data = refinement::simulatedDrive(makeSimulation(world, simulation), 1);
  const detail::MeshDistance mesh(data.mesh);
  const Meter<3> meter = [&](const std::vector<Vector<3>>& points) {
    return summarise(detail::meshDistances(points, mesh));
  };
  addRows<3>(name, build<3>(data.points, map), meter, options, rows);
}

void addSet(const refinement::DataSet& set, const ClusteringDistanceOptions& options,
            std::vector<ClusteringDistanceRow>& rows) {
  const refinement::LoadedData data = set.load(1);
  addRows<3>(set.name, build<3>(data.points, set.options), meterOf<3>(data.truth), options, rows);
}

/// The scans of the Intel Research Lab, as a planar map.
void addIntel(const fs::path& folder, const ClusteringDistanceOptions& options,
              std::vector<ClusteringDistanceRow>& rows) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".pcd") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<FileScan> scans;
  for (const fs::path& file : files) scans.push_back({file, normalised(PcdReader(file).header().viewpoint)});
  std::vector<Vector<2>> points;
  for (const Vector<3>& point : readPoints<3>(FileScans(scans), AccumulateOptions())) points.push_back(point.head<2>());
  addRows<2>("Intel lab, planar", build<2>(points, {0.05, 10, 3}), meterOf<2>(points), options, rows);
}

using Quantity = std::function<double(const ClusteringDistanceRow&)>;
const Quantity kQuantities[] = {[](const ClusteringDistanceRow& row) { return row.distortion; },
                                [](const ClusteringDistanceRow& row) { return row.to_reference.q99; },
                                [](const ClusteringDistanceRow& row) { return row.to_reference.q95; },
                                [](const ClusteringDistanceRow& row) { return row.to_reference.mean; },
                                [](const ClusteringDistanceRow& row) { return row.seconds; }};

std::string formatted(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::vector<std::string> dataNames(const std::vector<ClusteringDistanceRow>& rows) {
  std::vector<std::string> names;
  for (const ClusteringDistanceRow& row : rows)
    if (names.empty() || names.back() != row.data) names.push_back(row.data);
  return names;
}

/// Returns the geometric mean of the ratios of a quantity to that of the defaults: KL divergence, parent seed.
double ratioToDefault(const std::vector<ClusteringDistanceRow>& rows, const std::string& data,
                      GaussianDistance distance, ClusterSeed seed_rule, const Quantity& quantity) {
  double logarithms = 0.0;
  int count = 0;
  for (const ClusteringDistanceRow& row : rows) {
    if (row.data != data || row.distance != distance || row.seed_rule != seed_rule) continue;
    for (const ClusteringDistanceRow& other : rows)
      if (other.data == data && other.distance == KLKMeansOptions().distance &&
          other.seed_rule == KLKMeansOptions().seed_rule && other.budget == row.budget && other.scale == row.scale) {
        logarithms += std::log(quantity(row) / quantity(other));
        ++count;
      }
  }
  return std::exp(logarithms / count);
}

}  // namespace

std::vector<ClusteringDistanceRow> clusteringDistances(const ClusteringDistanceOptions& options) {
  std::vector<ClusteringDistanceRow> rows;
  addSimulated("simulated street", WorldName::Street, 6, {0.1, 10, 3}, options, rows);
  addSimulated("simulated hall", WorldName::Hall, 10, {0.1, 5, 3}, options, rows);
  if (options.data.empty()) return rows;
  for (const refinement::DataSet& set : refinement::dataSets(options.data, 1))
    if (set.name == "KITTI, one scan" || set.name == "RGB-D office") addSet(set, options, rows);
  addIntel(options.data / "carmen_intel", options, rows);
  return rows;
}

std::string clusteringDistanceRows(const std::vector<ClusteringDistanceRow>& rows) {
  std::string text =
      "| data | scale | per cell | new cluster | distance | Gaussians | KL distortion [nat] | 99 % [m] | 95 % [m] | "
      "mean "
      "[m] | time [s] |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const ClusteringDistanceRow& row : rows) {
    text += "| " + row.data + " | " + std::to_string(row.scale) + " | " + formatted("%g", row.budget) + " | " +
            nameOf(row.seed_rule) + " | " + nameOf(row.distance) + " | " + std::to_string(row.gaussians);
    text += formatted(" | %.3f", row.distortion) + formatted(" | %.3f", row.to_reference.q99) +
            formatted(" | %.3f", row.to_reference.q95) + formatted(" | %.4f", row.to_reference.mean) +
            formatted(" | %.2f |\n", row.seconds);
  }
  return text;
}

std::string clusteringDistanceSummary(const std::vector<ClusteringDistanceRow>& rows) {
  const std::vector<std::string> names = dataNames(rows);
  std::string text = "| new cluster | distance |", rule = "|---|---|";
  for (const std::string& name : names) {
    text += " " + name + " |";
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const ClusterSeed seed_rule : kSeeds)
    for (const NamedDistance& named : kDistances) {
      if (named.distance == KLKMeansOptions().distance && seed_rule == KLKMeansOptions().seed_rule) continue;  // all 1
      text += std::string("| ") + nameOf(seed_rule) + " | " + named.name + " |";
      for (const std::string& name : names) {
        for (const Quantity& quantity : kQuantities)
          text += formatted(" %.2f", ratioToDefault(rows, name, named.distance, seed_rule, quantity));
        text += " |";
      }
      text += "\n";
    }
  return text;
}

void addDistances(CLI::App& app) {
  const auto options = std::make_shared<ClusteringDistanceOptions>();
  CLI::App& command = *app.add_subcommand("distances", "distances between Gaussians in refinement by insertion");
  command.add_option("--data", options->data, "folder with kitti_6scans, rgbd_office_single, carmen_intel")
      ->check(CLI::ExistingDirectory);
  command.add_option("--scans", options->scans, "of the simulated drives; 0: some")->check(CLI::Range(0, 1000));
  command.add_option("--runs", options->runs, "per time")->check(CLI::Range(1, 100))->capture_default_str();
  command.callback([options] {
    const std::vector<ClusteringDistanceRow> rows = clusteringDistances(*options);
    std::printf("%s\nDistortion, 99 %%, 95 %%, mean and time, as multiples of those of KL with parent seed:\n\n%s",
                clusteringDistanceRows(rows).c_str(), clusteringDistanceSummary(rows).c_str());
  });
}

}  // namespace gaussmap::benchmark
