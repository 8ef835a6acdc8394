// SPDX-License-Identifier: BSD-3-Clause
#include "refinement_report.h"

#include <cstdio>

namespace gaussmap::refinement {
namespace {

using Json = nlohmann::ordered_json;
using Summary = DistanceSummary Run::*;
using Quantity = double DistanceSummary::*;

Figure figureOf(const Row& row, Summary summary, Quantity quantity) {
  return figure(row, [=](const Run& run) { return run.*summary.*quantity; });
}

void printFigure(const Figure& figure) {
  std::printf(" %.3g (%.3g) |", figure.mean, figure.worst);
}

void printRow(const Row& row, const std::string& name, bool simulated) {
  std::printf("| %s | %.0f |", name.c_str(),
              figure(row, [](const Run& run) { return static_cast<double>(run.gaussians); }).mean);
  for (const Quantity quantity : {&DistanceSummary::q99, &DistanceSummary::q95, &DistanceSummary::mean})
    printFigure(figureOf(row, &Run::to_truth, quantity));
  printFigure(figureOf(row, &Run::missed, &DistanceSummary::mean));
  if (simulated)
    for (const Summary summary : {&Run::to_mesh, &Run::to_hits})
      printFigure(figureOf(row, summary, &DistanceSummary::mean));
  std::printf("\n");
}

std::string budgetOf(const Row& row) {
  char text[40];
  std::snprintf(text, sizeof text, "%g x", row.budget);
  return text;
}

Json toJson(const DistanceSummary& d) {
  return {{"max", d.max}, {"q99", d.q99}, {"q95", d.q95}, {"mean", d.mean}};
}

Json toJson(const Row& row) {
  Json seeds = Json::array();
  for (const Run& run : row.runs) {
    Json seed = {{"gaussians", run.gaussians}, {"to_truth", toJson(run.to_truth)}, {"missed", toJson(run.missed)}};
    if (run.to_mesh.count > 0) seed["to_mesh"] = toJson(run.to_mesh);
    if (run.to_hits.count > 0) seed["to_hits"] = toJson(run.to_hits);
    seeds.push_back(seed);
  }
  return {{"method", row.method}, {"budget", row.budget}, {"seeds", seeds}};
}

}  // namespace

void printTable(const Table& table, const std::vector<Ratio>& ratios) {
  const DataSet& data = *table.data;
  const MapOptions& o = data.options;
  std::printf("### %s, cells of %g / %g / %g m\n\nTruth: %s.\n\n", data.name.c_str(), o.resolution,
              o.resolution * o.ratio, o.resolution * o.ratio * o.ratio, data.truth.c_str());
  std::printf("| coarsest scale | Gaussians | 99 %% | 95 %% | mean | truth to map, mean |%s\n",
              data.simulated ? " to the mesh, mean | to the rays' ends, mean |" : "");
  std::printf("|---|---|---|---|---|---|%s\n", data.simulated ? "---|---|" : "");
  for (const Row& row : table.rows)
    printRow(row, row.method == kOnePerCell ? row.method : budgetOf(row) + ", " + row.method, data.simulated);
  if (data.simulated) {
    printRow(table.middle, "middle scale, " + budgetOf(table.middle) + ", " + table.middle.method, true);
    printRow(table.finest, "finest scale", true);
  }
  std::printf("\n");
  for (const Ratio& ratio : ratios) std::printf("- %s: %.2f\n", ratio.text.c_str(), ratio.value);
  std::printf("\n");
  std::fflush(stdout);
}

void printOverview(const std::vector<Table>& tables) {
  const auto methods = {kOnePerCell, kPaper, kParentSeed, kAgglomeration, kUniformGrid};
  std::printf("| 99 %% / 95 %% / mean [m] |");
  for (const char* method : methods) std::printf(" %s |", method);
  std::printf("\n|---|---|---|---|---|---|\n");
  for (Table table : tables) {
    for (const double budget : table.data->budgets) {
      std::printf("| %s, %g x |", table.data->name.c_str(), budget);
      for (const char* method : methods) {
        const Row& row = table.row(method == kOnePerCell ? 1.0 : budget, method);
        std::printf(" %.3g / %.3g / %.3g |", figureOf(row, &Run::to_truth, &DistanceSummary::q99).mean,
                    figureOf(row, &Run::to_truth, &DistanceSummary::q95).mean,
                    figureOf(row, &Run::to_truth, &DistanceSummary::mean).mean);
      }
      std::printf("\n");
    }
  }
}

nlohmann::ordered_json toJson(const Table& table, const std::vector<Ratio>& ratios) {
  Json json = {{"data", table.data->name}, {"rows", Json::array()}, {"ratios", Json::array()}};
  for (const Row& row : table.rows) json["rows"].push_back(toJson(row));
  if (table.data->simulated) {
    json["middle"] = toJson(table.middle);
    json["finest"] = toJson(table.finest);
  }
  for (const Ratio& ratio : ratios) json["ratios"].push_back({{"what", ratio.text}, {"value", ratio.value}});
  return json;
}

}  // namespace gaussmap::refinement
