// SPDX-License-Identifier: BSD-3-Clause
#include "papers/details.h"

#include "common/report.h"
#include "core/parallel.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "refinement_data.h"
#include "simulation/simulation.h"

namespace gaussmap::papers {

std::vector<SurfaceRow> runSurfaces(std::size_t scans) {
  const Simulation simulation = makeSimulation(WorldName::Street, {static_cast<int>(scans), false});
  const refinement::LoadedData drive = refinement::simulatedDrive(simulation, 1);
  const GaussianMap<3> one = build<3>(drive.points, {0.1, 10, 3, 0.0});
  RefineOptions printed = RefineOptions::yguel2009(), parent = printed;
  parent.seed_rule = ClusterSeed::ParentCovariance;
  const std::vector<std::pair<std::string, RefineOptions>> methods = {{"one per cell", printed},
                                                                      {"as printed", printed},
                                                                      {"with parent seed", parent},
                                                                      {"agglomeration", RefineOptions()}};
  std::vector<SurfaceRow> rows(methods.size());
  detail::parallelFor(methods.size(), 0, 1, [&](std::size_t i) {
    const double budget = i == 0 ? 1.0 : 3.4;
    RefineOptions options = methods[i].second;
    options.threads = 1;
    const GaussianMap<3> map = i == 0 ? one : refine<3>(one, PerCell{budget}, options).map;
    rows[i] = {methods[i].first, budget, benchmark::budgetBySurface(map, map.scales() - 1, drive.mesh)};
  });
  return rows;
}

void reportSurfaces(const std::vector<SurfaceRow>& rows, Report& report) {
  report.heading(2, "Yguel, section 6: where the clusters go");
  report.paragraph(
      "The coarsest scale of the simulated street. A place is flat if all surface within 0.5 m lies in one plane. The "
      "other places are detail: edges, corners, and thin or curved objects.");
  std::vector<std::vector<std::string>> cells;
  for (const SurfaceRow& row : rows)
    cells.push_back({row.method, times(row.budget), std::to_string(row.surface.flat.gaussians),
                     std::to_string(row.surface.detail.gaussians), percent(row.surface.detailShareOfGaussians()),
                     percent(row.surface.detailShareOfArea())});
  report.table({"refinement", "limit", "Gaussians on flat surface", "Gaussians on detail", "share on detail",
                "share of detail in the surface"},
               cells);
  std::string figures, verdict;
  const double before = rows.front().surface.detailShareOfGaussians();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto added = [&](std::size_t now, std::size_t then) { return double(now) - double(then); };
    const double detail = added(rows[i].surface.detail.gaussians, rows.front().surface.detail.gaussians);
    const double flat = added(rows[i].surface.flat.gaussians, rows.front().surface.flat.gaussians);
    const double share = detail / (detail + flat);
    figures += (i == 1 ? "" : "; ") + rows[i].method + " " + percent(share);
    verdict += (i == 1 ? "" : "; ") + rows[i].method + ": " +
               (share > rows[i].surface.detailShareOfArea() + 0.05 ? "yes" : "no");
  }
  verdict[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(verdict[0])));
  report.claim({"Yguel", "sec. 6, Fig. 1", "Large flat clusters remain, and detail is added at poles and corners",
                "share of the added clusters that lies on detail: " + figures + ". Detail is " +
                    percent(rows.back().surface.detailShareOfArea()) + " of the surface, and had " + percent(before) +
                    " of the clusters before",
                verdict + "."});
}

void reportDistances(const std::vector<benchmark::ClusteringDistanceRow>& rows, Report& report) {
  report.heading(2, "Yguel, section 5.2: other distances in Algorithm 2");
  report.paragraph(
      "Algorithm 2 takes the distance from a Gaussian to a cluster as a parameter. Each cell of the table has five "
      "ratios to the KL divergence with parent seed, at equal numbers of Gaussians: distortion, 99 %, 95 %, mean, and "
      "time. They are geometric means over budgets and scales. Smaller is better. [The notes](notes/refinement.md) "
      "discuss the columns and the results.");
  report.paragraph(benchmark::clusteringDistanceSummary(rows));
}

}  // namespace gaussmap::papers
