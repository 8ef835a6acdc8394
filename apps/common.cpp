// SPDX-License-Identifier: BSD-3-Clause
#include "common.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <limits>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/pcd_scans.h"
#include "gaussmap/io/scans/pose_file.h"
#include "io/scans/pose_checks.h"

namespace gaussmap::app {
using namespace detail;

void addScanOptions(CLI::App& command, ScanInput& input) {
  command.add_option(
      "--poses", input.poses,
      "sensor poses in the map frame, one line a scan: TUM (t x y z qx qy qz qw), KITTI (12 numbers), or "
      "a file name in front; default: VIEWPOINT of each file");
  command.add_option("--frame", input.frame, "frame of the points in the files")
      ->check(CLI::IsMember({"sensor", "map"}))
      ->capture_default_str();
  command.add_option("--max-range", input.max_range, "leave out points farther from the sensor [m]; 0: no limit")
      ->check(numberBetween(0.0, 1e9))
      ->capture_default_str();
}

void warn(const std::string& text) {
  std::cerr << "gaussmap: warning: " << text << '\n';
}

PcdScans openScans(const ScanInput& input) {
  FoundScans found = findScans({input.paths.begin(), input.paths.end()}, input.poses,
                               input.frame == "map" ? ScanFrame::Map : ScanFrame::Sensor);
  for (const std::string& warning : found.warnings) warn(warning);
  return std::move(found.scans);
}

AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads) {
  return {resolution, input.max_range > 0.0 ? input.max_range : std::numeric_limits<double>::infinity(), threads};
}

CLI::Validator numberBetween(double low, double high) {
  std::ostringstream range;
  range << low << " to " << high;
  return CLI::Validator(
      [low, high, possible = range.str()](std::string& text) -> std::string {
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size()) return "'" + text + "' is not a number";
        return value >= low && value <= high ? "" : text + " is not in the range of " + possible;
      },
      range.str());
}

void addSeed(CLI::App& command, std::uint64_t& seed, const std::string& what) {
  const auto whole = [](std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size()
               ? ""
               : "'" + text + "' is not a whole number from 0 to 2^64 - 1";
  };
  command.add_option("--seed", seed, what)->check(CLI::Validator(whole, ""))->capture_default_str();
}

namespace {

/// Processors that this process may use.
int processors() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0
             ? CPU_COUNT(&set)
             : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// TBB warns on stderr when it is asked for more threads than there are processors.
std::string mostThreads(std::string& text) {
  int threads = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), threads);
  const bool number = error == std::errc() && end == text.data() + text.size();
  if (number && threads <= 1024) text = std::to_string(std::min(threads, processors()));
  return "";
}

}  // namespace

void addThreads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads, 0 = all; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->transform(CLI::Validator(mostThreads, ""))
      ->capture_default_str();
}

void addOutput(CLI::App& command, Output& output, const std::string& what) {
  command.add_option("-o,--output", output.path, what)->required();
  command.add_flag("--force", output.force, "replace an existing output");
}

void checkOutput(const Output& output, const std::vector<std::filesystem::path>& inputs) {
  const std::filesystem::path path = output.path, folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  for (const std::filesystem::path& input : inputs)
    for (const char* const written : {"", ".part"})  // the second one for the time of writing
      if (std::filesystem::equivalent(output.path + written, input, error))
        throw UsageError(output.path + ": writing it would destroy the input " + input.string() +
                         ", take another name");
  if (std::filesystem::is_directory(path, error) || !path.has_filename())
    throw UsageError("'" + output.path + "' is a directory: give the name of a file");
  if (!std::filesystem::is_directory(folder, error))
    throw UsageError(output.path + ": the directory " + folder.string() + " does not exist");
  if (access(folder.c_str(), W_OK) != 0)
    throw UsageError(output.path + ": the directory " + folder.string() + " cannot be written to");
  if (std::filesystem::exists(path, error) && !output.force)
    throw UsageError(output.path + " exists already: take another name, or --force to replace it");
}

void checkMapOutput(const Output& output, const std::vector<std::filesystem::path>& inputs) {
  checkOutput(output, inputs);
  if (std::filesystem::path(output.path).extension() == ".pcd")
    throw UsageError(output.path +
                     ": a map file is no PCD file, name it .gmap (gaussmap export makes a PCD file of it)");
}

std::string nameOf(const Scans& scans) {
  if (scans.size() == 0) return "";
  const std::string more = scans.size() > 1 ? " and " + std::to_string(scans.size() - 1) + " more" : "";
  return scans.info(0).name + more;
}

void printJson(const Json& json) {
  std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

ProgressBar::ProgressBar() : on_terminal_(isatty(STDERR_FILENO) != 0), start_(now()) {}

ProgressBar::~ProgressBar() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(const AccumulateProgress& progress) {
  if (!on_terminal_) return;
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(kWidth * progress.scans_done / std::max<std::size_t>(progress.scans, 1));
  const double rate = static_cast<double>(progress.points) / std::max(now() - start_, 1e-3);
  std::fprintf(stderr, "\r\033[K[%s%s] %zu/%zu scans, %.1f M points/s, %zu cells",
               std::string(std::size_t(filled), '#').c_str(), std::string(std::size_t(kWidth - filled), '.').c_str(),
               progress.scans_done, progress.scans, rate / 1e6, progress.cells);
  std::fflush(stderr);
  shown_ = true;
}

std::string humanBytes(std::uintmax_t bytes) {
  const char* units[] = {"B", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000.0 && unit + 1 < std::size(units); ++unit) value /= 1000.0;
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", value, units[unit]);
  return text;
}

void addHistory(MapMetadata& metadata, const Json& step) {
  Json history = Json::array();
  const auto entry = metadata.find("history");
  if (entry != metadata.end()) {
    const Json old = Json::parse(entry->second, nullptr, false);
    if (old.is_array()) history = old;
  }
  history.push_back(step);
  metadata["history"] = history.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json scalesOf(const GaussianMap<3>& map) {
  Json scales = Json::array();
  for (int s = 0; s < map.scales(); ++s)
    scales.push_back({{"scale", s},
                      {"cell_side", map.grid().side(s)},
                      {"cells", map.cellCount(s)},
                      {"gaussians", map.gaussianCount(s)},
                      {"weight", map.weight(s)}});
  return scales;
}

std::string perScale(const std::vector<std::size_t>& counts) {
  std::string text;
  for (const std::size_t count : counts) text += (text.empty() ? "" : " / ") + std::to_string(count);
  return text;
}

std::string perScale(const GaussianMap<3>& map) {
  std::vector<std::size_t> counts;
  counts.reserve(std::size_t(map.scales()));
  for (int s = 0; s < map.scales(); ++s) counts.push_back(map.gaussianCount(s));
  return perScale(counts);
}

std::string perScale(const GaussianMap<3>& map, const GaussianMap<3>& whole) {
  std::string text;
  for (int s = 0; s < map.scales(); ++s)
    text +=
        (s > 0 ? " / " : "") + std::to_string(map.gaussianCount(s)) + " of " + std::to_string(whole.gaussianCount(s));
  return text;
}

void reportMap(const std::string& path, const GaussianMap<3>& map, const std::string& counts, double start, bool json) {
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  if (json)
    printJson({{"map", path}, {"scales", scalesOf(map)}, {"bytes", bytes}, {"seconds", now() - start}});
  else
    std::cout << path << ": Gaussians per scale " << counts << ", " << humanBytes(bytes) << '\n';
}

}  // namespace gaussmap::app
