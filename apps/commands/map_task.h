// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "commands/any_map.h"
#include "common/command.h"
#include "common/json.h"

namespace gaussmap::app {

/// The options that all commands with maps as input and a map as output share.
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

/// The report of a command about the map that it has written.
struct MapReport {
  std::string counts;  // Gaussians per scale, see perScale()
  std::string before;  // text before the counts, with its comma
  bool tell_time = false;
  Json scales;       // see scalesOf()
  Json first, last;  // more members of the JSON object: before "scales" and after "bytes"
};

/// The steps of a command that writes a map: load, add a step to the history, save, report.
class MapTask {
 public:
  /// Checks that the output can be written and does not replace an input. Starts the clock. Throws UsageError.
  MapTask(const MapTaskOptions& options, const std::vector<std::filesystem::path>& inputs);
  explicit MapTask(const MapTaskOptions& options) : MapTask(options, {options.map}) {}

  /// Loads a map and its metadata, which save() writes again. See loadMap().
  template <int D>
  GaussianMap<D> load(const std::string& path) {
    return loadMap<D>(path, &metadata);
  }
  template <int D>
  GaussianMap<D> load() {
    return load<D>(options_.map);
  }

  MapMetadata metadata;
  /// Adds {"command", "version"} and the members of `more` to the history. Drops the error curves, because they
  /// describe the old map.
  void addStep(const char* command, const Json& more = Json::object());

  /// Saves the map. The options of the command replace `save.overwrite` and `save.threads`.
  template <int D>
  void save(const GaussianMap<D>& map, SaveOptions save = {}) const;

  /// Prints the result as one line or as JSON. Call it after save().
  void report(const MapReport& report) const;
  /// The same with the scales of the map. `whole` is the map that it was made from; its counts are printed too.
  template <int D>
  void report(const GaussianMap<D>& map) const;
  template <int D>
  void report(const GaussianMap<D>& map, const GaussianMap<D>& whole, const Json& last = {}) const;

  /// Size of the written map and of the input [bytes].
  std::uintmax_t bytes() const { return std::filesystem::file_size(options_.output.path); }
  std::uintmax_t bytesBefore() const { return std::filesystem::file_size(options_.map); }

 private:
  MapTaskOptions options_;
  double start_;
};

}  // namespace gaussmap::app
