// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/scans/pcd_scans.h"
#include "gaussmap/mapping/accumulate_scans.h"
#include "gaussmap/version.h"

namespace gaussmap::app {

using Json = nlohmann::ordered_json;

/// Options that make no sense: exit code 2. Everything else that goes wrong is exit code 1.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// One function per command, called once by main.
void addPcd2map(CLI::App& app);
void addRefine(CLI::App& app);
void addCompress(CLI::App& app);
void addRegister(CLI::App& app);
void addFinish(CLI::App& app);
void addTiles(CLI::App& app);
void addSimplify(CLI::App& app);
void addMerge(CLI::App& app);
void addTransform(CLI::App& app);
void addCrop(CLI::App& app);
void addDiff(CLI::App& app);
void addClean(CLI::App& app);
void addRestore(CLI::App& app);
void addInfo(CLI::App& app);
void addExport(CLI::App& app);
void addHausdorff(CLI::App& app);
void addSimulate(CLI::App& app);
void addDraw(CLI::App& app);
void addSegments(CLI::App& app);
void addView(CLI::App& app);

/// One line on stderr.
void warn(const std::string& text);

/// Which clouds, and how they lie in the map: the same words for every command that reads scans.
struct ScanInput {
  std::vector<std::string> paths;
  std::string poses;
  std::string frame = "sensor";
  double max_range = 0.0;  // 0: no limit
};
void addScanOptions(CLI::App& command, ScanInput& input);

/// findScans(); warnings go to stderr.
PcdScans openScans(const ScanInput& input);
AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads);

/// A number from `low` to `high`; unlike CLI::Range it takes no NaN.
CLI::Validator numberBetween(double low, double high);
/// Adds --seed; a negative number is none.
void addSeed(CLI::App& command, std::uint64_t& seed, const std::string& what);
/// Adds --threads (0 = all).
void addThreads(CLI::App& command, int& threads);
/// Adds -o/--output (required) and --force.
struct Output {
  std::string path;
  bool force = false;
};
void addOutput(CLI::App& command, Output& output, const std::string& what);
/// Throws UsageError, before any work is done: the output is one of the inputs, or no file, or its folder does not
/// exist or may not be written, or the output exists and --force is not given.
void checkOutput(const Output& output, const std::vector<std::filesystem::path>& inputs = {});
/// The same for a map file, which must not be named like a PCD file.
void checkMapOutput(const Output& output, const std::vector<std::filesystem::path>& inputs);

/// A line on stderr that is written over; silent unless stderr is a terminal.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  void show(const AccumulateProgress& progress);

 private:
  bool on_terminal_;
  bool shown_ = false;
  double start_;
};

/// "scan.pcd", or "scan.pcd and 4 more".
std::string nameOf(const Scans& scans);

/// To stdout. File names need not be UTF-8, as JSON must: their other bytes are replaced.
void printJson(const Json& json);

/// Seconds of a steady clock.
double now();
/// "12.3 MB".
std::string humanBytes(std::uintmax_t bytes);

/// Adds what was done to the history of a map file.
void addHistory(MapMetadata& metadata, const Json& step);

/// Cells and Gaussians of every scale.
Json scalesOf(const GaussianMap<3>& map);

/// "526732 / 11327 / 129", finest first.
std::string perScale(const std::vector<std::size_t>& counts);
/// The Gaussians of a map in that way; with the map that it was made from: "1000 of 526732 / 20 of 11327".
std::string perScale(const GaussianMap<3>& map);
std::string perScale(const GaussianMap<3>& map, const GaussianMap<3>& whole);

/// What a command says of the map that it has written: file, `counts` (see perScale()) and bytes, or all for machines.
void reportMap(const std::string& path, const GaussianMap<3>& map, const std::string& counts, double start, bool json);

}  // namespace gaussmap::app
