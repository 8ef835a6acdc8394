// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <locale>
#include <sstream>

#include "commands/segments/segments.h"
#include "common/report.h"
#include "common/usage.h"
#include "gaussmap/core/error.h"

namespace gaussmap::app {
namespace {

/// Adds one line per scan: the quantities of Leal 2000, Figs. 7 and 8.
void addStatistics(std::ostream& table, std::size_t scan, const std::string& name, const SegmentStatistics& s) {
  table << scan << ',' << csvQuoted(name) << ',' << s.beams << ',' << s.associated << ',' << s.created << ','
        << s.splits << ',' << s.merges << ',' << s.pruned << ',' << s.segments << ',' << s.normal_variance << ','
        << s.coverage << '\n';
}

/// Returns the circle in which the utility demands more detail after the last scan.
std::optional<SegmentPicture::Field> fieldOf(const FitterInput& fitting, const Vector<2>& observer) {
  if (!fitting.viewpoint.empty())
    return SegmentPicture::Field{{fitting.viewpoint[0], fitting.viewpoint[1]}, fitting.viewpoint[2]};
  if (fitting.utility == "viewpoint-dependent")
    return SegmentPicture::Field{observer, fitting.view_radius.value_or(ViewpointDependentOptions().radius)};
  return {};
}

}  // namespace

FittedSegments fitSegments(const SegmentsCommand& command, const LaserScans& input) {
  SegmentFitter fitter(fitterOptions(command.fitter), makeUtility(command.fitter));
  const std::vector<Vector<2>> path =
      command.fitter.observer_path.empty() ? std::vector<Vector<2>>() : readObserverPath(command.fitter.observer_path);
  std::ostringstream table;
  table.imbue(std::locale::classic());
  table << "scan,file,beams,associated,created,splits,merges,pruned,segments,normal_variance,coverage\n";
  FittedSegments fitted;
  Vector<2> observer(0.0, 0.0);
  const double start = now();
  const auto every = static_cast<std::size_t>(command.every);
  for (std::size_t i = 0; i < input.scans.size(); ++i) {
    if (i % every != 0) {
      fitted.left_out.push_back(input.scans[i]);
      continue;
    }
    fitted.last = fitter.add(input.scans[i]);
    observer = input.scans[i].pose.translation;
    addStatistics(table, i, input.names[i], fitted.last);
    fitted.beams += fitted.last.beams;
    fitted.splits += fitted.last.splits;
    fitted.merges += fitted.last.merges;
    fitted.pruned += fitted.last.pruned;
  }
  if (fitted.beams == 0)
    throw FileError(input.files.front(), "no beam of the scans has a return, so there is nothing to map");
  const std::string path_name = std::filesystem::path(command.fitter.observer_path).filename().string();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const SegmentStatistics step = fitter.observe(path[i]);
    observer = path[i];
    addStatistics(table, input.scans.size() + i, path_name + ":" + std::to_string(i), step);
    fitted.observer_splits += step.splits;
    fitted.observer_merges += step.merges;
    fitted.last.segments = step.segments;
    fitted.last.normal_variance = step.normal_variance;
  }
  fitted.map = fitter.map();
  fitted.seconds = now() - start;
  fitted.scans = fitter.scans();
  fitted.memory = fitter.memoryBytes();
  fitted.statistics = table.str();
  if (command.evidence || command.evidence_beside) fitted.picture.evidence = fitter.evidence();
  fitted.picture.field = fieldOf(command.fitter, observer);
  fitted.picture.path = path;
  return fitted;
}

LaserScans testScans(const SegmentsCommand& command, const std::vector<LaserScan>& left_out) {
  const std::vector<std::string>& inputs = command.input.scans.paths;
  std::error_code error;
  const bool is_input = std::any_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
    return std::filesystem::equivalent(input, command.evaluate, error);
  });
  LaserScans test;
  if (is_input) {
    test.scans = left_out;
  } else {
    LaserInput input = command.input;
    input.scans.paths = {command.evaluate};
    input.scans.poses.clear();
    test = readLaserScans(input);
  }
  if (test.scans.empty())
    throw UsageError("--evaluate: all scans are in the map; use --every 2 to keep every second scan out of it");
  return test;
}

}  // namespace gaussmap::app
