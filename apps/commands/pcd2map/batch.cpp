// SPDX-License-Identifier: BSD-3-Clause
#include "commands/pcd2map/pcd2map.h"
#include "commands/pcd2map/scan_report.h"
#include "common/progress_bar.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap::app {

template <int D>
WrittenMap buildInMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                         MapTask& task) {
  ProgressBar bar;
  AccumulatedScans<D> accumulated = readChecked<D>(scans, options.slice, [&](const Scans& checked) {
    return accumulateScans<D>(checked, reading, [&](const AccumulateProgress& progress) { bar.show(progress); });
  });
  const PointCounts counts = accumulated.counts;
  requirePoints(counts, scans, options.slice);
  GaussianMap<D> map = build<D>(accumulated.moments, options.map);
  accumulated.moments = MomentGrid<D>(options.map.resolution);  // frees its memory before the refinement
  map = refineWithin(std::move(map), options.budget, task.metadata, historyOf(scans, counts, options.slice));
  task.save(map);
  return {counts, scalesOf(map)};
}
template WrittenMap buildInMemory<2>(const Pcd2mapOptions&, const Scans&, const AccumulateOptions&, MapTask&);
template WrittenMap buildInMemory<3>(const Pcd2mapOptions&, const Scans&, const AccumulateOptions&, MapTask&);

}  // namespace gaussmap::app
