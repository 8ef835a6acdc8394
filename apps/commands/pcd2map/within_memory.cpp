// SPDX-License-Identifier: BSD-3-Clause
#include "commands/pcd2map/pcd2map.h"
#include "commands/pcd2map/scan_report.h"
#include "common/progress_bar.h"
#include "gaussmap/io/gmap/build_map_file.h"
#include "gaussmap/io/gmap/map_file.h"

namespace gaussmap::app {

void checkMemory(const Pcd2mapOptions& options) {
  if (options.max_memory.empty()) return;
  if (options.online.on || options.budget.method != "agglomerate" || !options.budget.max_gaussians.empty() ||
      !options.budget.max_bytes.empty() || options.budget.max_error > 0.0)
    throw UsageError(
        "--max-memory: supports only --budget, because --online, --method insert, --max-gaussians, --max-bytes and "
        "--max-error need the whole map in memory; use gaussmap refine afterwards");
  if (amountOf("--max-memory", options.max_memory, true) < kMinBuildMemory)
    throw UsageError("--max-memory " + options.max_memory + ": at least " + std::to_string(kMinBuildMemory) +
                     " bytes are needed");
}

template <int D>
WrittenMap buildWithinMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                             const MapTask& task) {
  BuildMapFileOptions building;
  building.max_memory = amountOf("--max-memory", options.max_memory, true);
  building.refine = options.budget.refine;
  building.budget = PerCell{options.budget.budget};
  building.refine.merge_cost = mergeCost(options.budget);
  building.save = {options.output.force, SaveOptions().compression, options.budget.refine.threads};
  const auto metadataOf = [&](const PointCounts& counts) {
    requirePoints(counts, scans, options.slice);
    MapMetadata metadata = task.metadata;
    // The same step as that of refineWithin(), so that the files are identical.
    const std::string details = detailsOf(options.budget, historyOf(scans, counts, options.slice));
    recordStep(metadata, refineStep(building.budget, building.refine, details));
    return metadata;
  };
  ProgressBar bar;
  const BuiltMapFile built = readChecked<D>(scans, options.slice, [&](const Scans& checked) {
    return buildMapFile<D>(checked, reading, options.map, options.output.path, metadataOf, building,
                           [&](const AccumulateProgress& progress) { bar.show(progress); });
  });
  WrittenMap written{built.counts, Json::array()};
  const Grid<D> grid(options.map);
  for (int s = 0; s < grid.scales(); ++s)
    written.scales.push_back({{"scale", s},
                              {"cell_side", grid.side(s)},
                              {"cells", built.cells[static_cast<std::size_t>(s)]},
                              {"gaussians", built.gaussians[static_cast<std::size_t>(s)]},
                              {"weight", static_cast<double>(built.counts.accepted)}});
  return written;
}
template WrittenMap buildWithinMemory<2>(const Pcd2mapOptions&, const Scans&, const AccumulateOptions&, const MapTask&);
template WrittenMap buildWithinMemory<3>(const Pcd2mapOptions&, const Scans&, const AccumulateOptions&, const MapTask&);

}  // namespace gaussmap::app
