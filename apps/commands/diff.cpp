// SPDX-License-Identifier: BSD-3-Clause
// gaussmap diff A B: finds what is new, gone or changed in B.
#include <cstdio>
#include <memory>

#include "commands/any_map.h"
#include "commands/commands.h"
#include "common/box.h"
#include "common/command.h"
#include "common/json.h"
#include "common/report.h"
#include "gaussmap/editing/diff_maps.h"
#include "gaussmap/map/queries.h"
#include "io/export/diff_pcd.h"

namespace gaussmap::app {
namespace {

struct DiffCommand {
  std::string first, second;
  std::string output;
  bool force = false, json = false;
  DiffOptions diff;
};

const Help kDiffHelp = {
    "Compare two maps of the same place: what is new, gone or changed",
    "gaussmap diff monday.gmap tuesday.gmap -o changes.pcd --level 0.001",
    R"(The file of --output holds all Gaussians of the second map and the gone Gaussians of the first map. Its fields
are x y z covariance[6] weight p_value label. Labels: 0 the same, or too few points to decide; 1 new; 2 gone;
3 changed. Places that the sensors of the second map never observed count as gone too. Prefer the finest scale: at
refined coarse scales, the same surface can be divided into other clusters, which then count as changed.)"};

/// Warns if the maps share no cell, or nearly none, because then everything is new or gone.
template <int D>
void warnOfOverlap(const DiffCommand& options, const GaussianMap<D>& first, const GaussianMap<D>& second) {
  constexpr double kFewest = 0.01;
  const int s = options.diff.scale;
  const auto &few = first.cellCount(s) < second.cellCount(s) ? first : second, &many = &few == &first ? second : first;
  const auto extent = extentOf<D>(first), other = extentOf<D>(second);
  if (!extent || !other) return;
  std::size_t shared = 0;
  for (const CellKey<D>& key : few.scale(s).keys) shared += many.find(key, s).has_value();
  if (static_cast<double>(shared) >= kFewest * static_cast<double>(few.cellCount(s)) && shared > 0) return;
  warn(options.first + " and " + options.second +
       (shared == 0 ? " do not overlap" : " hardly overlap: " + std::to_string(shared) + " common cells") + " (" +
       textOf(*extent) + " and " + textOf(*other) + "); are both in the same frame? See gaussmap transform");
}

template <int D>
void run(const DiffCommand& options) {
  if (!options.output.empty()) {
    requireExtension(options.output, ".pcd");
    checkOutput({options.output, options.force}, {options.first, options.second});
  }
  const double start = now();
  const GaussianMap<D> first = loadMap<D>(options.first), second = loadMap<D>(options.second);
  const int s = options.diff.scale;
  checkScale("--scale", s, first.scales(), options.first);
  checkScale("--scale", s, second.scales(), options.second);
  if (first.grid().side(s) == second.grid().side(s)) warnOfOverlap(options, first, second);
  const MapDiff diff = diffMaps<D>(first, second, options.diff);
  if (!options.output.empty()) detail::writeDiffPcd(options.output, spaceMap(first), spaceMap(second), diff, s);
  const std::size_t none = diff.count(Change::None), fresh = diff.count(Change::New), gone = diff.count(Change::Gone),
                    changed = diff.count(Change::Changed);
  if (options.json) {
    Json result = {{"first", options.first},
                   {"second", options.second},
                   {"scale", s},
                   {"level", options.diff.level},
                   {"gaussians", {first.gaussianCount(s), second.gaussianCount(s)}},
                   {"same", none},
                   {"new", fresh},
                   {"gone", gone},
                   {"changed", changed},
                   {"seconds", now() - start}};
    if (!options.output.empty()) result["output"] = options.output;
    printJson(result);
    return;
  }
  std::printf("%s -> %s, scale %d (%g m), level %g: %zu new, %zu gone, %zu changed, %zu the same\n",
              options.first.c_str(), options.second.c_str(), s, first.grid().side(s), options.diff.level, fresh, gone,
              changed, none);
}

}  // namespace

void addDiff(CLI::App& app) {
  auto options = std::make_shared<DiffCommand>();
  Command command(app, "diff", kDiffHelp);
  command.text("first", options->first, "map (.gmap, or PCD of Gaussians)").required();
  command.text("second", options->second, "later map, in the same frame and with cells of the same side").required();
  command.text("-o,--output", options->output, "labelled Gaussians to write (.pcd)");
  command.force(options->force);
  command.scale(options->diff.scale, "scale to compare, 0 = finest");
  command.number("--level", options->diff.level, 1e-12, 0.5,
                 "significance level: a change is reported if its p-value is at most this");
  command
      .number("--points", options->diff.points, 1.0, 1e9,
              R"(maximum number of points of a Gaussian that the test counts as independent;
          a larger number finds smaller movements, but also reports errors of the poses as changes)")
      .rare();
  command.threads(options->diff.threads);
  command.json(options->json);
  command.files({"first", "second"}, {".gmap", ".pcd"});
  command.files({"--output"}, {".pcd"});
  command.onRun([options] { forMap(options->first, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
