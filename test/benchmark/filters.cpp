// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark filters [DIR or PCD...] [--json FILE]: compares GaussianMapFilter with pcl::VoxelGrid,
// UniformSampling and GridMinimum at the same number of points. The claim is about coverage: the distances from the
// points of the input to the nearest kept point (95 %, mean). The distances from kept points to the input are printed
// too; they are 0 for filters that keep points unchanged. One thread. The runs of the filters alternate. A time is the
// median of the processor times.
#include <pcl/filters/grid_minimum.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/filters/voxel_grid.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "clouds.h"
#include "gaussmap/pcl/gaussian_map_filter.h"
#include "points/nearest_distances.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Points = std::vector<Vector<3>>;

Points finitePoints(const Cloud& cloud) {
  Points points;
  for (const auto& p : cloud)
    if (p.getVector3fMap().allFinite()) points.push_back(p.getVector3fMap().cast<double>());
  return points;
}

struct Distances {
  double q95 = 0.0, mean = 0.0;
};

Distances distancesOf(const Points& from, const Points& to) {
  std::vector<double> all = nearestDistances(from, to, 1);
  std::sort(all.begin(), all.end());
  return {all[all.size() * 95 / 100], std::accumulate(all.begin(), all.end(), 0.0) / double(all.size())};
}

struct FilterRow {
  std::string filter;
  std::size_t kept = 0;
  Distances to_kept, to_input;
  double seconds = 0.0;
};

/// A filter that is measured: the call of filter() and its last output.
struct MeasuredFilter {
  std::string name;
  std::function<void(Cloud&)> run;
  std::size_t repeats = 1;  // per time
  std::vector<double> seconds;
};

template <typename Filter>
MeasuredFilter measured(const std::string& name, const std::shared_ptr<Filter>& filter, const NamedCloud& input) {
  filter->setInputCloud(input.cloud);
  return {name, [filter](Cloud& kept) { filter->filter(kept); }, 1, {}};
}

MeasuredFilter ours(const std::string& name, std::size_t budget, FilterMethod method, FilterOutput output,
                    const NamedCloud& input) {
  GaussianMapFilterOptions options;
  options.budget = budget;
  options.method = method;
  options.output = output;
  options.threads = 1;
  return measured(name, std::make_shared<GaussianMapFilter<pcl::PointXYZ>>(false, options), input);
}

class Comparison {
 public:
  explicit Comparison(int runs) : runs_(runs) {}

  void compare(const NamedCloud& input) {
    const Points points = finitePoints(*input.cloud);
    std::printf("\n%s, %zu points\n\n", input.name.c_str(), points.size());
    std::printf(
        "| %-30s | kept   | input to kept 95 %% | mean     | kept to input 95 %% | mean     | time [ms] | / VoxelGrid |"
        "\n",
        "[m]");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    Eigen::Vector3d low = points.front(), high = low;
    for (const auto& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (const double share : {0.01, 0.05, 0.2}) {
      const double leaf = leafFor(input, share, (high - low).maxCoeff());
      char text[32];
      std::snprintf(text, sizeof text, ", %.3g m", leaf);
      const auto voxels = std::make_shared<pcl::VoxelGrid<pcl::PointXYZ>>();
      voxels->setLeafSize(float(leaf), float(leaf), float(leaf));
      const auto uniform = std::make_shared<pcl::UniformSampling<pcl::PointXYZ>>();
      uniform->setRadiusSearch(leaf);
      const auto minimum = std::make_shared<pcl::GridMinimum<pcl::PointXYZ>>(float(leaf));
      std::vector<MeasuredFilter> filters;
      filters.push_back(measured(std::string("VoxelGrid") + text, voxels, input));
      filters.push_back(measured(std::string("UniformSampling") + text, uniform, input));
      filters.push_back(measured(std::string("GridMinimum") + text, minimum, input));
      const std::size_t kept = keptBy(filters[0]), kept_minimum = keptBy(filters[2]);
      filters.push_back(ours("GaussianMapFilter", kept, FilterMethod::Map, FilterOutput::Means, input));
      filters.push_back(ours("GaussianMapFilter, samples", kept, FilterMethod::Map, FilterOutput::Samples, input));
      filters.push_back(ours("GaussianMapFilter, split", kept, FilterMethod::Split, FilterOutput::Means, input));
      filters.push_back(ours("GaussianMapFilter, fewer", kept_minimum, FilterMethod::Map, FilterOutput::Means, input));
      const std::vector<FilterRow> rows = measure(filters, input.name, points);
      count(rows[3], rows[0]);
      count(rows[3], rows[1]);
      count(rows[6], rows[2]);
      const double ratio = rows[3].seconds / rows[0].seconds;
      ratios_.push_back(ratio);
      voxel_won_ += rows[3].to_kept.q95 < rows[0].to_kept.q95 && rows[3].to_kept.mean < rows[0].to_kept.mean;
    }
  }

  void printSummary() const {
    std::printf("\nGaussianMapFilter nearer (input to kept, 95 %% and mean) in %zu of %zu comparisons\n", won_,
                compared_);
    if (ratios_.empty()) return;
    std::vector<double> ratios = ratios_;
    std::sort(ratios.begin(), ratios.end());
    std::printf(
        "beside VoxelGrid: both distances smaller in %zu of %zu cases; time / VoxelGrid: median %.2f, max %.2f\n",
        voxel_won_, ratios.size(), ratios[ratios.size() / 2], ratios.back());
  }

  nlohmann::json json;

 private:
  /// Returns the leaf size with which pcl::VoxelGrid keeps about this share of the points.
  static double leafFor(const NamedCloud& input, double share, double extent) {
    const auto target = double(input.cloud->size()) * share;
    double small = extent / 2000.0, large = extent;
    for (int i = 0; i < 12; ++i) {
      const double leaf = std::sqrt(small * large);
      pcl::VoxelGrid<pcl::PointXYZ> voxels;
      voxels.setLeafSize(float(leaf), float(leaf), float(leaf));
      voxels.setInputCloud(input.cloud);
      Cloud kept;
      voxels.filter(kept);
      (double(kept.size()) > target ? small : large) = leaf;
    }
    return large;
  }

  static std::size_t keptBy(const MeasuredFilter& filter) {
    Cloud kept;
    filter.run(kept);
    return kept.size();
  }

  std::vector<FilterRow> measure(std::vector<MeasuredFilter>& filters, const std::string& cloud, const Points& points) {
    constexpr double kLeastSeconds = 1e-3;  // shorter calls are repeated
    Cloud kept;
    for (MeasuredFilter& filter : filters) {
      const double start = processorSeconds();
      filter.run(kept);
      filter.repeats = std::size_t(std::clamp(kLeastSeconds / (processorSeconds() - start + 1e-9), 1.0, 1000.0));
    }
    for (int run = 0; run < runs_; ++run)
      for (MeasuredFilter& filter : filters) {
        const double start = processorSeconds();
        for (std::size_t i = 0; i < filter.repeats; ++i) filter.run(kept);
        filter.seconds.push_back((processorSeconds() - start) / double(filter.repeats));
      }
    std::vector<FilterRow> rows;
    for (MeasuredFilter& filter : filters) {
      filter.run(kept);
      const Points kept_points = finitePoints(kept);
      std::sort(filter.seconds.begin(), filter.seconds.end());
      FilterRow row;
      row.filter = filter.name;
      row.kept = kept_points.size();
      row.to_kept = distancesOf(points, kept_points);
      row.to_input = distancesOf(kept_points, points);
      row.seconds = filter.seconds[filter.seconds.size() / 2];
      rows.push_back(row);
      const double ratio = row.seconds / rows[0].seconds;
      std::printf("| %-30s | %6zu | %10.4g | %10.4g | %10.4g | %10.4g | %8.4g | %5.2f |\n", row.filter.c_str(),
                  row.kept, row.to_kept.q95, row.to_kept.mean, row.to_input.q95, row.to_input.mean, 1e3 * row.seconds,
                  ratio);
      json.push_back({{"cloud", cloud},
                      {"filter", row.filter},
                      {"kept", row.kept},
                      {"input_to_kept_95", row.to_kept.q95},
                      {"input_to_kept_mean", row.to_kept.mean},
                      {"kept_to_input_95", row.to_input.q95},
                      {"kept_to_input_mean", row.to_input.mean},
                      {"seconds", row.seconds},
                      {"times_voxel_grid", ratio}});
    }
    std::fflush(stdout);
    return rows;
  }

  void count(const FilterRow& ours, const FilterRow& peer) {
    compared_ += 2;
    won_ += std::size_t(ours.to_kept.q95 < peer.to_kept.q95) + std::size_t(ours.to_kept.mean < peer.to_kept.mean);
  }

  int runs_;
  std::size_t won_ = 0, compared_ = 0, voxel_won_ = 0;
  std::vector<double> ratios_;
};

}  // namespace

void addFilters(CLI::App& app) {
  struct Given {
    std::vector<std::string> paths;
    std::string json;
    int runs = 5;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("filters", "GaussianMapFilter beside PCL's filters, with as many points");
  command.add_option("clouds", given->paths, "PCD files, or directories of which the first scan counts");
  command.add_option("--runs", given->runs, "of which the median counts")->check(CLI::Range(1, 100));
  command.add_option("--json", given->json, "file for machines");
  command.callback([given] {
    Comparison comparison(given->runs);
    for (const NamedCloud& cloud : loadClouds(given->paths)) comparison.compare(cloud);
    comparison.printSummary();
    if (!given->json.empty()) std::ofstream(given->json) << comparison.json.dump(2) << '\n';
  });
}

}  // namespace gaussmap::benchmark
