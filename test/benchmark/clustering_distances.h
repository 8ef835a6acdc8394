// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/evaluation/hausdorff.h"

namespace gaussmap::benchmark {

/// The result of one refinement by insertion, at one coarse scale.
struct ClusteringDistanceRow {
  std::string data;     // name of the data set
  int scale = 1;        // coarse scale
  double budget = 2.0;  // Gaussians per cell
  GaussianDistance distance = GaussianDistance::KL;
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;
  std::size_t gaussians = 0;     // number of Gaussians of the scale
  double distortion = 0.0;       // mean of KL(finest Gaussian || its ancestor at the scale), by weight [nat]
  DistanceSummary to_reference;  // from samples of the scale to the reference [m]
  double seconds = 0.0;          // processor time of the refinement of all scales, one thread [s]
};

struct ClusteringDistanceOptions {
  std::filesystem::path data;                // folder with real data sets; empty: only simulated data
  int scans = 0;                             // of the simulated drives; 0: a number that suits a run of minutes
  std::vector<double> budgets = {2.0, 3.4};  // Gaussians per cell
  int runs = 1;                              // refinements per row, which take turns; seconds is their median
};

/// Refines each data set by insertion with every GaussianDistance, every ClusterSeed and every budget. The rows are
/// ordered by data set, seed, budget, distance and scale. Uses one thread for the refinements.
std::vector<ClusteringDistanceRow> clusteringDistances(const ClusteringDistanceOptions& options);

/// Returns all rows as a Markdown table.
std::string clusteringDistanceRows(const std::vector<ClusteringDistanceRow>& rows);
/// Returns one Markdown table with a row per distance and seed and a column per data set. The figures are geometric
/// means over budgets and scales of the ratios to the default, the KL divergence with ClusterSeed::ParentCovariance, at
/// the same budget and scale: distortion, 99 %, 95 %, mean, time.
std::string clusteringDistanceSummary(const std::vector<ClusteringDistanceRow>& rows);

}  // namespace gaussmap::benchmark
