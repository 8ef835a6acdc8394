// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "papers/report.h"
#include "papers/sequences.h"

namespace gaussmap::papers {

/// The coarsest scale of a map that was refined off line.
struct RefinedRow {
  std::string method;
  double budget = 1.0;  ///< Gaussians per cell
  std::size_t gaussians = 0;
  DistanceSummary distances;      ///< of a fixed number of samples
  double within_two_sigma = 0.0;  ///< the largest distance of a sample within 2 sigma [m]
};

/// How much the Hausdorff distance of the coarsest scale falls while clusters are added, four at a time.
struct StallRow {
  std::string method;
  std::size_t rounds = 0;   ///< rounds of four clusters
  std::size_t stalled = 0;  ///< rounds in which the maximum falls by less than 1 %
};

/// The results of one data set.
struct OffLine {
  std::string name;
  int dimensions = 3;
  std::size_t finest = 0;  ///< Gaussians of the finest scale
  std::vector<RefinedRow> rows;
  std::vector<StallRow> stalls;
};

/// Refines the map of all scans with each method, and makes a uniform grid of as many Gaussians (3-D).
template <int D>
OffLine runOffLine(const Sequence<D>& sequence);

/// Returns the row of a method at a budget. Throws std::out_of_range if it does not exist.
const RefinedRow& rowOf(const OffLine& results, const std::string& method, double budget);

/// Adds the table and the plot of these results to the report.
void reportOffLine(const OffLine& results, Report& report);

}  // namespace gaussmap::papers
