// SPDX-License-Identifier: BSD-3-Clause
#include "commands/map_task.h"

#include <iostream>

#include "common/command.h"
#include "common/report.h"
#include "gaussmap/io/pcd/map_pcd.h"

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

GaussianMap<3> MapTask::load(const std::string& path) {
  return loadAny(path, &metadata);
}

void MapTask::addStep(const char* command, const Json& more) {
  metadata.erase("error_curves");
  addHistory(metadata, historyStep(command, more));
}

void MapTask::save(const GaussianMap<3>& map, SaveOptions save) const {
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

void MapTask::report(const GaussianMap<3>& map) const {
  MapReport said;
  said.counts = perScale(map);
  said.scales = scalesOf(map);
  report(said);
}

void MapTask::report(const GaussianMap<3>& map, const GaussianMap<3>& whole, const Json& last) const {
  MapReport said;
  said.counts = perScale(map, whole);
  said.scales = scalesOf(map);
  said.last = last;
  report(said);
}

}  // namespace gaussmap::app
