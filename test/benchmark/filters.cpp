// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark filters [DIR or PCD...] [--json FILE]: compares GaussianMapFilter with pcl::VoxelGrid,
// UniformSampling and GridMinimum at the same number of points. The claim is about coverage: the distances from the
// points of the input to the nearest kept point (95 %, mean). The distances from kept points to the input are printed
// too; they are 0 for filters that keep points unchanged. One thread.
#include <pcl/filters/grid_minimum.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/filters/voxel_grid.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
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

class Comparison {
 public:
  explicit Comparison(int runs) : runs_(runs) {}

  void compare(const NamedCloud& input) {
    std::printf("\n%s, %zu points\n\n", input.name.c_str(), finitePoints(*input.cloud).size());
    std::printf(
        "| %-30s | kept   | input to kept 95 %% | mean     | kept to input 95 %% | mean     | max of 95 %% | time [ms] "
        "|\n",
        "[m]");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    const Points points = finitePoints(*input.cloud);
    Eigen::Vector3d low = points.front(), high = low;
    for (const auto& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (const double share : {0.01, 0.05, 0.2}) {
      const double leaf = leafFor(input, share, (high - low).maxCoeff());
      pcl::VoxelGrid<pcl::PointXYZ> voxels;
      voxels.setLeafSize(float(leaf), float(leaf), float(leaf));
      const std::size_t kept = peer("VoxelGrid", voxels, input, points, leaf);
      pcl::UniformSampling<pcl::PointXYZ> uniform;
      uniform.setRadiusSearch(leaf);
      peer("UniformSampling", uniform, input, points, leaf);
      ours(input, points, kept);
      pcl::GridMinimum<pcl::PointXYZ> minimum{float(leaf)};
      ours(input, points, peer("GridMinimum", minimum, input, points, leaf));
    }
  }

  nlohmann::json json;
  std::size_t won = 0, compared = 0;

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

  template <typename Filter>
  FilterRow measure(const std::string& name, Filter& filter, const NamedCloud& input, const Points& points) {
    Cloud kept;
    filter.setInputCloud(input.cloud);
    FilterRow row;
    row.filter = name;
    row.seconds = minSeconds(runs_, [&] { filter.filter(kept); });
    const Points kept_points = finitePoints(kept);
    row.kept = kept_points.size();
    row.to_kept = distancesOf(points, kept_points);
    row.to_input = distancesOf(kept_points, points);
    std::printf("| %-30s | %6zu | %10.4g | %10.4g | %10.4g | %10.4g | %10.4g | %8.1f |\n", name.c_str(), row.kept,
                row.to_kept.q95, row.to_kept.mean, row.to_input.q95, row.to_input.mean,
                std::max(row.to_kept.q95, row.to_input.q95), 1e3 * row.seconds);
    std::fflush(stdout);
    json.push_back({{"cloud", input.name},
                    {"filter", name},
                    {"kept", row.kept},
                    {"input_to_kept_95", row.to_kept.q95},
                    {"input_to_kept_mean", row.to_kept.mean},
                    {"kept_to_input_95", row.to_input.q95},
                    {"kept_to_input_mean", row.to_input.mean},
                    {"seconds", row.seconds}});
    return row;
  }

  template <typename Filter>
  std::size_t peer(const std::string& name, Filter& filter, const NamedCloud& input, const Points& points,
                   double leaf) {
    char text[64];
    std::snprintf(text, sizeof text, "%s, %.3g m", name.c_str(), leaf);
    peers_.push_back(measure(text, filter, input, points));
    return peers_.back().kept;
  }

  /// Measures both outputs. The default output is compared with the peers measured since the last call.
  void ours(const NamedCloud& input, const Points& points, std::size_t budget) {
    for (const FilterOutput output : {FilterOutput::Means, FilterOutput::Samples}) {
      GaussianMapFilter<pcl::PointXYZ> filter;
      filter.setBudget(budget);
      filter.setOutput(output);
      filter.setNumberOfThreads(1);
      const FilterRow row = measure(output == FilterOutput::Means ? "GaussianMapFilter" : "GaussianMapFilter, samples",
                                    filter, input, points);
      if (output != filter_default_) continue;
      for (const FilterRow& peer : peers_) {
        compared += 2;
        won += std::size_t(row.to_kept.q95 < peer.to_kept.q95) + std::size_t(row.to_kept.mean < peer.to_kept.mean);
      }
    }
    peers_.clear();
  }

  static constexpr FilterOutput filter_default_ = FilterOutput::Means;
  int runs_;
  std::vector<FilterRow> peers_;
};

}  // namespace

void addFilters(CLI::App& app) {
  struct Given {
    std::vector<std::string> paths;
    std::string json;
    int runs = 3;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("filters", "GaussianMapFilter beside PCL's filters, with as many points");
  command.add_option("clouds", given->paths, "PCD files, or directories of which the first scan counts");
  command.add_option("--runs", given->runs, "of which the fastest counts")->check(CLI::Range(1, 100));
  command.add_option("--json", given->json, "file for machines");
  command.callback([given] {
    Comparison comparison(given->runs);
    for (const NamedCloud& cloud : loadClouds(given->paths)) comparison.compare(cloud);
    std::printf("\nGaussianMapFilter nearer (input to kept, 95 %% and mean) in %zu of %zu comparisons\n",
                comparison.won, comparison.compared);
    if (!given->json.empty()) std::ofstream(given->json) << comparison.json.dump(2) << '\n';
  });
}

}  // namespace gaussmap::benchmark
