// SPDX-License-Identifier: BSD-3-Clause
#include <locale>
#include <sstream>
#include <stdexcept>

#include "commands/pcd2map/pcd2map.h"
#include "commands/pcd2map/scan_report.h"
#include "common/progress_bar.h"
#include "common/report.h"
#include "io/pcd/removed_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

/// A CSV file with one line per scan.
class StatisticsTable {
 public:
  explicit StatisticsTable(int scales) : scales_(static_cast<std::size_t>(scales)) {
    text_.imbue(std::locale::classic());
    text_ << "scan,file,points,cells_touched,cells_new,cells_tested,cells_visited,added,deleted,update_s,image_s,"
             "look_back_s,occupancy_s,forget_s,refine_s";
    for (int s = 1; s < scales; ++s) text_ << ",error_" << s;
    text_ << '\n';
  }

  void add(std::size_t scan, const std::string& name, const OnlineStatistics& s) {
    text_ << scan << ',' << csvQuoted(name) << ',' << s.points.accepted << ',' << s.cells_touched << ',' << s.cells_new
          << ',' << s.cells_tested << ',' << s.cells_visited << ',' << s.added << ',' << s.deleted << ','
          << s.update_time << ',' << s.image_time << ',' << s.look_back_time << ',' << s.occupancy_time << ','
          << s.forget_time << ',' << s.refine_time;
    for (std::size_t scale = 1; scale < scales_; ++scale) {
      text_ << ',';
      if (scale < s.errors.size()) text_ << s.errors[scale];  // empty field: this scan refined nothing
    }
    text_ << '\n';
  }

  std::string text() const { return text_.str(); }

 private:
  std::size_t scales_;
  std::ostringstream text_;
};

/// Returns a scan as the mapper takes it. For a planar map, its beams lie in the plane.
template <int D>
Scan scanFor(const Pcd2mapOptions& options, const Scans& scans, std::size_t index, const AccumulateOptions& reading) {
  return D == 2 ? sweepOf(scans, index, options.slice, reading.min_range) : scans.read(index);
}

}  // namespace

template <int D>
WrittenMap buildOnline(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                       MapTask& task) {
  const OnlineInput& online = options.online;
  std::vector<RemovedCluster<D>> removed;
  typename OnlineMapper<D>::Removed note;
  if (!online.removed.empty()) note = [&](const RemovedCluster<D>& cluster) { removed.push_back(cluster); };
  // The beams of a planar map have no heights, so the limits of a slice do not apply to them.
  const AccumulateOptions limits =
      D == 2 ? accumulateOptions(options.input, options.map.resolution, reading.threads) : reading;
  OnlineMapper<D> mapper(onlineOptions(online, options.map, limits, options.budget), note);

  PointCounts counts;
  std::size_t deleted = 0;  // clusters of all scales
  const std::vector<std::string> names = shortNamesOf(scans);
  StatisticsTable table(options.map.scales);
  ProgressBar bar;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const ScanInfo scan = scans.info(i);
    OnlineStatistics statistics;
    try {
      statistics = mapper.add(scanFor<D>(options, scans, i, reading));
    } catch (const std::out_of_range& error) {
      throw std::out_of_range(scan.name + ": " + error.what());
    }
    counts += statistics.points;
    table.add(i, names[i], statistics);
    deleted += statistics.deleted;
    bar.show({i + 1, scans.size(), counts.accepted, 0});
  }
  if (!options.slice.empty()) {
    counts.read -= counts.non_finite;  // these are beams without a point in the slice
    counts.non_finite = 0;
  }
  requirePoints(counts, scans, options.slice);
  if (!online.stats.empty()) writeText(online.stats, table.text());
  if (!online.removed.empty()) writeRemoved(online.removed, removed);

  Json step = historyOf(scans, counts, options.slice);
  step["online"] = true;
  if (online.as_in_paper) step["as_in_paper"] = true;
  step["budget"] = options.budget.budget;
  step["deleted"] = deleted;
  addHistory(task.metadata, step);
  const GaussianMap<D> map = mapper.map();
  task.save(map);
  return {counts, scalesOf(map)};
}
template WrittenMap buildOnline<2>(const Pcd2mapOptions&, const Scans&, const AccumulateOptions&, MapTask&);
template WrittenMap buildOnline<3>(const Pcd2mapOptions&, const Scans&, const AccumulateOptions&, MapTask&);

}  // namespace gaussmap::app
