// SPDX-License-Identifier: BSD-3-Clause
#include "commands/pcd2map/pcd2map.h"
#include "commands/pcd2map/scan_report.h"
#include "common/progress_bar.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap::app {

WrittenMap buildInMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                         MapTask& task) {
  ProgressBar bar;
  AccumulatedScans accumulated =
      accumulateScans(scans, reading, [&](const AccumulateProgress& progress) { bar.show(progress); });
  const PointCounts counts = accumulated.counts;
  requirePoints(counts, scans);
  GaussianMap<3> map = build<3>(accumulated.moments, options.map);
  accumulated.moments = MomentGrid<3>(options.map.resolution);  // frees its memory before the refinement
  map = refineWithin(std::move(map), options.budget, task.metadata, historyOf(scans, counts));
  task.save(map);
  return {counts, scalesOf(map)};
}

}  // namespace gaussmap::app
