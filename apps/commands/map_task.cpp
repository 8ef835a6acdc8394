// SPDX-License-Identifier: BSD-3-Clause
#include "commands/map_task.h"

#include <iostream>

#include "common/command.h"
#include "common/report.h"

namespace gaussmap::app {

void addMapToMap(Command& command, MapTaskOptions& options) {
  command.map(options.map);
  addMapOutput(command, options);
}

void addMapOutput(Command& command, MapTaskOptions& options) {
  command.output(options.output, "map file to write (.gmap)");
  command.files({"--output"}, {".gmap"});
}

void addRunOptions(Command& command, MapTaskOptions& options) {
  command.threads(options.threads);
  command.json(options.json);
}

MapTask::MapTask(const MapTaskOptions& options, const std::vector<std::filesystem::path>& inputs) : options_(options) {
  checkMapOutput(options.output, inputs);
  start_ = now();
}

void MapTask::addStep(const char* command, const Json& more) {
  metadata.erase("error_curves");
  addHistory(metadata, historyStep(command, more));
}

template <int D>
void MapTask::save(const GaussianMap<D>& map, SaveOptions save) const {
  save.overwrite = options_.output.force;
  save.threads = options_.threads;
  gaussmap::save(options_.output.path, map, metadata, save);
}

void MapTask::report(const MapReport& report) const {
  const double seconds = now() - start_;
  if (options_.json) {
    Json json = {{"map", options_.output.path}};
    if (!report.first.is_null()) json.update(report.first);
    json["scales"] = report.scales;
    json["bytes"] = bytes();
    if (!report.last.is_null()) json.update(report.last);
    json["seconds"] = seconds;
    return printJson(json);
  }
  std::cout << options_.output.path << ": " << report.before << "Gaussians per scale " << report.counts << ", "
            << humanBytes(bytes());
  if (report.tell_time) std::cout << ", " << secondsText(seconds) << " s";
  std::cout << '\n';
}

template <int D>
void MapTask::report(const GaussianMap<D>& map) const {
  MapReport said;
  said.counts = perScale(map);
  said.scales = scalesOf(map);
  report(said);
}

template <int D>
void MapTask::report(const GaussianMap<D>& map, const GaussianMap<D>& whole, const Json& last) const {
  MapReport said;
  said.counts = perScale(map, whole);
  said.scales = scalesOf(map);
  said.last = last;
  report(said);
}

#define GAUSSMAP_INSTANTIATE(D)                                          \
  template void MapTask::save(const GaussianMap<D>&, SaveOptions) const; \
  template void MapTask::report(const GaussianMap<D>&) const;            \
  template void MapTask::report(const GaussianMap<D>&, const GaussianMap<D>&, const Json&) const;
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::app
