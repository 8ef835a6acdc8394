// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "gaussmap/evaluation/hausdorff.h"
#include "refinement_data.h"

namespace gaussmap::refinement {

inline constexpr const char* kOnePerCell = "one per cell";
inline constexpr const char* kPaper = "insertion as in the paper";
inline constexpr const char* kParentSeed = "insertion with parent seed";
inline constexpr const char* kAgglomeration = "agglomeration";
inline constexpr const char* kUniformGrid = "uniform grid";

/// The result of one seed: distances of samples.
struct Run {
  std::size_t gaussians = 0;
  DistanceSummary to_truth;
  DistanceSummary missed;            // from the truth to the samples
  DistanceSummary to_mesh, to_hits;  // simulated: to the exact surface, and to the points where rays met it
};

/// The results of one method at one budget.
struct Row {
  double budget = 1.0;
  std::string method;
  std::vector<Run> runs;
};

/// The results of one data set.
struct Table {
  const DataSet* data = nullptr;
  std::vector<Row> rows;                // of the coarsest scale
  Row middle{2.0, kAgglomeration, {}};  // simulated: the next finer scale, and the finest
  Row finest{1.0, kOnePerCell, {}};

  Row& row(double budget, const std::string& method) {
    for (Row& row : rows)
      if (row.budget == budget && row.method == method) return row;
    rows.push_back({budget, method, {}});
    return rows.back();
  }
};

/// The mean and the worst value of a number over the seeds.
struct Figure {
  double mean = 0.0, worst = 0.0;
};
template <typename Value>
Figure figure(const Row& row, const Value& value) {
  Figure figure;
  for (const Run& run : row.runs) {
    figure.mean += value(run) / static_cast<double>(row.runs.size());
    figure.worst = std::max(figure.worst, value(run));
  }
  return figure;
}

/// A ratio of two figures.
struct Ratio {
  std::string text;  // "numerator / denominator"
  double value = 0.0;
};

}  // namespace gaussmap::refinement
