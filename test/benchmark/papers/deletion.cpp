// SPDX-License-Identifier: BSD-3-Clause
#include "papers/deletion.h"

#include <algorithm>
#include <utility>

#include "common/report.h"
#include "core/parallel.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "papers/sequences.h"
#include "simulation/simulation.h"

namespace gaussmap::papers {
using namespace detail;

namespace {

constexpr std::size_t kScans = 60;
constexpr std::size_t kFinestSamples = 200000;

struct Traffic {
  Sequence<3> sequence;
  std::vector<std::vector<bool>> moves;  // per scan and point
};

Traffic streetWithTraffic(std::size_t scans) {
  const Simulation simulation = makeSimulation(WorldName::Street, {static_cast<int>(kScans), true});
  Traffic traffic;
  traffic.sequence = {"street with traffic", {0.1, 10, 3, 0.0}, {}, {}};
  traffic.sequence.mesh = std::make_shared<const MeshDistance>(simulation.world.mesh());
  for (std::size_t i = 0; i < (scans > 0 ? std::min(scans, kScans) : kScans); ++i) {
    SimulatedScan scan = simulateScan(simulation, i);
    traffic.moves.emplace_back();
    for (const SurfaceLabel label : scan.labels) traffic.moves.back().push_back(label == SurfaceLabel::Moving);
    traffic.sequence.scans.push_back({std::move(scan.points), scan.pose, 0, std::nullopt});
  }
  return traffic;
}

DeletionRow rowWith(const std::string& method, OnlineOptions options, const Traffic& traffic) {
  options.map = traffic.sequence.map;
  options.refine_every = 0;  // the finest scale does not depend on it
  options.threads = 1;
  OnlineMapper<3> mapper(options);
  for (const Scan& scan : traffic.sequence.scans) mapper.add(scan);
  const GaussianMap<3> map = mapper.map();
  DeletionRow row{method, {}, 0.0};
  for (std::size_t s = 0; s < traffic.moves.size(); ++s) {
    const Scan& scan = traffic.sequence.scans[s];
    for (std::size_t p = 0; p < scan.points.size(); ++p)
      row.score.add(traffic.moves[s][p], !map.find(map.grid().keyOf(scan.pose * scan.points[p]), 0));
  }
  row.finest_mean = distancesOf(map, 0, kFinestSamples, traffic.sequence, traffic.sequence.scans.size()).all.mean;
  return row;
}

}  // namespace

std::vector<DeletionRow> runDeletion(std::size_t scans) {
  const Traffic traffic = streetWithTraffic(scans);
  OnlineOptions printed = OnlineOptions::yguel2009(3), exact = printed;
  exact.learning_rate = LearningRate::SampleMean;
  const std::vector<std::pair<std::string, OnlineOptions>> methods = {
      {"as printed", printed}, {"as printed, but exact sums", exact}, {"defaults of the library", OnlineOptions()}};
  std::vector<DeletionRow> rows(methods.size());
  parallelFor(methods.size(), 0, 1,
              [&](std::size_t i) { rows[i] = rowWith(methods[i].first, methods[i].second, traffic); });
  return rows;
}

void reportDeletion(const std::vector<DeletionRow>& rows, Report& report) {
  std::vector<std::vector<std::string>> cells;
  for (const DeletionRow& row : rows)
    cells.push_back({row.method, percent(row.score.staticAccuracy()), percent(row.score.dynamicAccuracy()),
                     app::formatted("%.2f", 1000.0 * row.finest_mean)});
  report.paragraph(
      "The simulated street with three moving cars and two pedestrians, 60 scans, finest cells of 0.1 m. A point of a "
      "scan counts as deleted if the map has no finest cell at its place at the end. \"Exact sums\": each cell has the "
      "exact mean and covariance of all its points (`--learning-rate sample-mean`).");
  report.table({"on-line map", "points at rest that are kept", "points of moving objects that are deleted",
                "finest scale, mean distance to the surface [mm]"},
               cells);
  const DeletionRow &printed = rows[0], &exact = rows[1], &own = rows[2];
  const double gone = printed.score.dynamicAccuracy(), kept = printed.score.staticAccuracy();
  report.claim({"Yguel", "sec. 5.3, 7", "Clusters of low occupancy are deleted, which deals with moving objects",
                "as printed, " + percent(gone) + " of the points of moving objects and " + percent(1.0 - kept) +
                    " of those at rest are deleted; with the defaults of the library, " +
                    percent(own.score.dynamicAccuracy()) + " and " + percent(1.0 - own.score.staticAccuracy()),
                gone > 0.9 && kept > 0.99   ? "True."
                : gone > 0.5 && kept > 0.95 ? "Partly: a part of the moving objects stays."
                : kept <= 0.95              ? "Partly: it also deletes surfaces at rest."
                                            : "Hardly: most of the moving objects stay."});
  const double ratio = printed.finest_mean / exact.finest_mean;
  report.claim({"Yguel", "sec. 4.4, eq. (5)", "A learning rate from the occupancy lets clusters converge",
                "mean distance of the finest scale from the surface, divided by that with exact sums: " + times(ratio),
                ratio < 1.05  ? "True: the clusters are as good as exact sums."
                : ratio < 1.5 ? "Partly: the clusters come near to exact sums, but stay behind them."
                              : "Not true here: exact sums are better, and they do not depend on the order."});
}

}  // namespace gaussmap::papers
