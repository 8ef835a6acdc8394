// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "budget_by_surface.h"
#include "clustering_distances.h"
#include "papers/report.h"

namespace gaussmap::papers {

/// Where a refinement spends its Gaussians on the simulated street.
struct SurfaceRow {
  std::string method;
  double budget = 1.0;
  benchmark::BudgetBySurface surface;
};

/// Refines the coarsest scale of the simulated street with each method. At most `scans` scans; 0: all.
std::vector<SurfaceRow> runSurfaces(std::size_t scans);

void reportSurfaces(const std::vector<SurfaceRow>& rows, Report& report);
/// Adds the measured table of the distances of KLKMeans.
void reportDistances(const std::vector<benchmark::ClusteringDistanceRow>& rows, Report& report);

}  // namespace gaussmap::papers
