// SPDX-License-Identifier: BSD-3-Clause
#include "io/logs/carmen_scans.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "io/files/text.h"
#include "segments/level_scan.h"

namespace gaussmap::detail {
namespace {

constexpr std::string_view kMessages[] = {"PARAM",       "SYNC",      "ODOM",      "FLASER",      "RLASER",
                                          "LASER3",      "LASER4",    "LASER5",    "RAWLASER1",   "RAWLASER2",
                                          "RAWLASER3",   "RAWLASER4", "RAWLASER5", "ROBOTLASER0", "ROBOTLASER1",
                                          "ROBOTLASER2", "TRUEPOS",   "GPS",       "MARKER"};
constexpr std::size_t kMaxWarnings = 5;  // per log

/// Reads one sweep. The sweeps of a log are shared by its readers.
class SweepReader : public ScanReader {
 public:
  SweepReader(std::shared_ptr<const CarmenLog> log, std::size_t scan)
      : log_(std::move(log)), scan_(log_->scans[scan]) {}

  std::size_t size() const override { return scan_.ranges.size(); }
  void read(std::size_t first, PointBlock<3>& block) const override {
    block.size = first < size() ? std::min(PointBlock<3>::kCapacity, size() - first) : 0;
    for (std::size_t i = 0; i < block.size; ++i) {
      const Eigen::Vector3d point = pointOf(scan_, first + i);
      for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][i] = point(axis);
    }
  }

 private:
  std::shared_ptr<const CarmenLog> log_;
  const LaserScan& scan_;
};

/// Returns true if each sweep has a time, and no two neighbours have the same one.
bool hasUsefulTimes(const std::vector<LaserScan>& scans) {
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (!scans[i].time || (i > 0 && scans[i].time == scans[i - 1].time)) return false;
  return true;
}

class CarmenScans : public ScanFile {
 public:
  explicit CarmenScans(CarmenLog log)
      : log_(std::make_shared<const CarmenLog>(std::move(log))), has_times_(hasUsefulTimes(log_->scans)) {}

  std::string kind() const override { return "CARMEN log"; }
  std::size_t size() const override { return log_->scans.size(); }
  FileScanInfo info(std::size_t scan) const override {
    const LaserScan& sweep = log_->scans[scan];
    FileScanInfo info;
    info.name = size() > 1 ? "scan " + std::to_string(scan) : "";
    info.points = sweep.ranges.size();
    info.pose = poseOf(sweep);
    constexpr double kLargest = 4e9;  // [s]; nanoseconds of larger times are out of range
    if (has_times_ && std::abs(*sweep.time) < kLargest)
      info.time = std::chrono::nanoseconds(std::llround(*sweep.time * 1e9));
    return info;
  }
  std::unique_ptr<ScanReader> open(std::size_t scan) const override {
    return std::make_unique<SweepReader>(log_, scan);
  }
  std::string poseSource() const override { return "pose of the laser in each line of the log"; }
  std::size_t memoryOf(std::size_t) const override { return 0; }
  std::vector<std::string> warnings() const override { return warningsOf(*log_); }

 private:
  std::shared_ptr<const CarmenLog> log_;
  bool has_times_;
};

}  // namespace

bool isCarmenText(std::string_view start) {
  constexpr std::string_view kHeader = "# message formats defined";
  while (!start.empty()) {
    const bool is_cut = start.find('\n') == std::string_view::npos;
    const std::string_view line = takeLine(start);
    if (line.substr(0, kHeader.size()) == kHeader) return true;
    const std::vector<std::string_view> words = splitWords(line);
    if (words.empty() || words.front().front() == '#') continue;
    const bool is_message = std::find(std::begin(kMessages), std::end(kMessages), words.front()) != std::end(kMessages);
    return is_message && (words.size() > 1 || is_cut);
  }
  return false;
}

std::vector<std::string> warningsOf(const CarmenLog& log) {
  std::vector<std::string> warnings;
  const std::size_t shown = std::min(log.faults.size(), kMaxWarnings);
  for (std::size_t i = 0; i < shown; ++i)
    warnings.push_back("line " + std::to_string(log.faults[i].line) + " is left out: " + log.faults[i].what);
  const std::size_t more = log.faults.size() - shown + log.more_faults;
  if (more > 0) warnings.push_back(std::to_string(more) + " more lines are left out");
  return warnings;
}

std::unique_ptr<ScanFile> openCarmenScans(const std::filesystem::path& path) {
  return std::make_unique<CarmenScans>(readCarmenLog(path));
}

}  // namespace gaussmap::detail
