// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "common/command.h"
#include "common/json.h"

namespace gaussmap::app {

/// The options that all commands share that turn maps into a map.
struct MapTaskOptions {
  std::string map;  // the input
  Output output;
  int threads = 0;
  bool json = false;
};
/// Adds MAP, -o and --force.
void addMapToMap(Command& command, MapTaskOptions& options);
/// Adds -o and --force.
void addMapOutput(Command& command, MapTaskOptions& options);
/// Adds --threads and --json.
void addRunOptions(Command& command, MapTaskOptions& options);

/// What a command says about the map that it has written.
struct MapReport {
  std::string counts;  // Gaussians per scale, see perScale()
  std::string before;  // text in front of them, with its comma
  bool tell_time = false;
  Json scales;       // see scalesOf()
  Json first, last;  // further members of the JSON: before "scales", after "bytes"
};

/// A command that writes a map: load, compute, add to the history, save, report.
class MapTask {
 public:
  /// Checks, before any work is done, that the output can be written and destroys no input. Starts the clock.
  MapTask(const MapTaskOptions& options, const std::vector<std::filesystem::path>& inputs);
  explicit MapTask(const MapTaskOptions& options) : MapTask(options, {options.map}) {}

  /// Loads a map with its metadata, which save() hands on.
  GaussianMap<3> load(const std::string& path);
  GaussianMap<3> load() { return load(options_.map); }

  MapMetadata metadata;
  /// Adds {"command", "version"} and `more` to the history, and drops error curves, which describe the map as it was.
  void addStep(const char* command, const Json& more = Json::object());

  /// `save.overwrite` and `save.threads` are set by the options of the command.
  void save(const GaussianMap<3>& map, SaveOptions save = {}) const;

  /// Prints the result, after save(): one line, or JSON.
  void report(const MapReport& report) const;
  /// The same with the scales of the map. `whole`: the map that it was made from, whose counts are printed too.
  void report(const GaussianMap<3>& map) const;
  void report(const GaussianMap<3>& map, const GaussianMap<3>& whole, const Json& last = {}) const;

  /// Size of the written map and of the input [bytes].
  std::uintmax_t bytes() const { return std::filesystem::file_size(options_.output.path); }
  std::uintmax_t bytesBefore() const { return std::filesystem::file_size(options_.map); }

 private:
  MapTaskOptions options_;
  double start_;
};

}  // namespace gaussmap::app
