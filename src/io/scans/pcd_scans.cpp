// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/scans/pcd_scans.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "io/scans/assign_poses.h"
#include "io/scans/coordinate_checks.h"
#include "io/scans/keeping_points.h"
#include "io/scans/pose_checks.h"
#include "io/scans/scan_names.h"
#include "sensor/sensor_motion.h"

namespace gaussmap {
using namespace detail;

/// Readers that have their points in memory, until the next call of open(). Thread-safe.
class detail::KeptReaders {
 public:
  using Reader = std::shared_ptr<const PcdReader>;

  /// Limits the memory of the points of readers that are kept from now on [bytes].
  void allow(std::size_t bytes) {
    const std::lock_guard<std::mutex> lock(mutex_);
    budget_ = bytes;
  }
  /// Removes the kept reader of a scan and returns it; returns nullptr if none is kept.
  Reader take(std::size_t scan) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = readers_.find(scan);
    if (found == readers_.end()) return nullptr;
    Reader reader = std::move(found->second);
    readers_.erase(found);
    return reader;
  }
  /// Keeps the reader of a scan if its points stay in memory and are within the limit.
  void keep(std::size_t scan, const Reader& reader) {
    const PcdHeader& header = reader->header();
    const std::size_t bytes = std::max(3 * sizeof(double), header.record_size) * header.points;  // at most
    const std::lock_guard<std::mutex> lock(mutex_);
    if (bytes > budget_ || (header.encoding == PcdEncoding::Binary && !reader->isGzip())) return;
    if (readers_.emplace(scan, reader).second) budget_ -= bytes;
  }

 private:
  std::mutex mutex_;
  std::size_t budget_ = 0;
  std::map<std::size_t, Reader> readers_;
};

namespace {

// Maximum number of files that stay open: each takes a memory map and a few kilobytes. Other files are opened again
// when they are read.
constexpr std::size_t kMaxOpen = 1024;

/// Returns what to write if the scans are in subfolders, as in 000000/cloud.pcd.
std::string hintOfSubfolders(const std::filesystem::path& directory) {
  std::error_code error;
  for (std::filesystem::directory_iterator folder(directory, error), end; !error && folder != end;
       folder.increment(error)) {
    std::error_code ignored;
    if (!folder->is_directory(ignored)) continue;
    for (std::filesystem::directory_iterator file(folder->path(), ignored), last; !ignored && file != last;
         file.increment(ignored))
      if (isScanName(file->path().filename()))
        return ", but in its subdirectories: name them, for example " + (directory / "*").string() + "/" +
               file->path().filename().string();
  }
  return "";
}

std::vector<std::filesystem::path> scansIn(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> scans;
  std::error_code error;
  std::filesystem::directory_iterator entry(directory, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    // A broken link or a pipe stays in the list: the reader reports what is wrong with it.
    std::error_code ignored;
    if (isScanName(entry->path().filename()) && !entry->is_directory(ignored)) scans.push_back(entry->path());
  }
  if (error) throw FileError(directory, "cannot be listed: " + error.message());
  if (scans.empty()) throw FileError(directory, "no .pcd file in this directory" + hintOfSubfolders(directory));
  std::sort(scans.begin(), scans.end(),
            [](const auto& a, const auto& b) { return naturalLess(a.filename().string(), b.filename().string()); });
  return scans;
}

/// Returns the name of a field element in the interface ScanReader: "intensity", or "normal[0]" if the field
/// has several elements.
std::string valueName(const PcdField& field, std::size_t element) {
  return field.count == 1 ? field.name : field.name + "[" + std::to_string(element) + "]";
}

class PcdScanReader : public ScanReader {
 public:
  PcdScanReader(std::shared_ptr<const PcdReader> reader, std::size_t index, std::shared_ptr<CoordinateSamples> samples)
      : reader_(std::move(reader)), index_(index), samples_(std::move(samples)) {}

  std::size_t size() const override { return reader_->size(); }
  int columns() const override {
    const PcdHeader& header = reader_->header();
    return header.height > 1 ? static_cast<int>(header.width) : 0;
  }
  void read(std::size_t first, PointBlock<3>& block) const override {
    reader_->read(first, block);
    samples_->add(index_, first, block, size());
  }
  void requireWhole() const override { reader_->requireWhole(); }

  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const PcdField& field : reader_->header().fields)
      for (std::size_t element = 0; isValue(field) && element < field.count; ++element)
        if (const std::string name = valueName(field, element);
            std::find(names.begin(), names.end(), name) == names.end())
          names.push_back(name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const PcdField& field : reader_->header().fields)
      for (std::size_t element = 0; isValue(field) && element < field.count; ++element)
        if (valueName(field, element) == name) return reader_->column(field.name, element);
    return ScanReader::values(name);
  }

 private:
  static bool isValue(const PcdField& field) {
    return field.name != "x" && field.name != "y" && field.name != "z" && field.name != "_";
  }

  std::shared_ptr<const PcdReader> reader_;
  std::size_t index_;
  std::shared_ptr<CoordinateSamples> samples_;
};

PcdReader openScan(const std::filesystem::path& path) {
  PcdReader reader(path);
  if (reader.header().find("covariance") != nullptr && reader.header().find("cell_side") != nullptr)
    throw FileError(path,
                    "holds the Gaussians of a map, not the points of a scan; a directory of such tiles becomes a map "
                    "with gaussmap tiles DIR -o MAP");
  return reader;
}

/// Warns if a scan is given more than once, for example as a file and by its directory.
void warnOfScansGivenTwice(const std::vector<std::filesystem::path>& paths, std::vector<std::string>& warnings) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& path : paths) {
    std::error_code error;
    if (seen.insert(std::filesystem::weakly_canonical(path, error)).second || error) continue;
    warnings.push_back(path.string() + " is given more than once, so its points count more than once");
    return;
  }
}

/// Returns true if the points of scans with the same pose show that the sensor stood still.
bool standsStill(PcdScans& scans) {
  const KeepingPoints keeping(scans);
  try {
    const std::optional<SameView> views = compareViews(scans);
    return views && !views->moved();
  } catch (const FileError&) {
    return false;  // a later read reports it
  }
}

}  // namespace

PcdScans::PcdScans(std::vector<PcdScan> scans, ScanFrame frame, std::vector<PcdReader> opened)
    : scans_(std::move(scans)),
      opened_(std::move(opened)),
      frame_(frame),
      samples_(std::make_shared<CoordinateSamples>(scans_.size())),
      kept_(std::make_shared<KeptReaders>()) {
  for (std::size_t i = opened_.size(); i < scans_.size(); ++i) {
    PcdReader reader(scans_[i].path);
    if (i < kMaxOpen) opened_.push_back(std::move(reader));
  }
}

PcdScans::~PcdScans() = default;
PcdScans::PcdScans(PcdScans&&) noexcept = default;
PcdScans& PcdScans::operator=(PcdScans&&) noexcept = default;

ScanInfo PcdScans::info(std::size_t index) const {
  const PcdScan& scan = scans_.at(index);
  return {scan.path.string(), scan.pose, scan.time};
}

PcdReader PcdScans::reader(std::size_t index) const {
  return index < opened_.size() ? opened_[index].sameFile() : PcdReader(scans_.at(index).path);
}

std::unique_ptr<ScanReader> PcdScans::open(std::size_t index) const {
  std::shared_ptr<const PcdReader> opened = kept_->take(index);
  if (!opened) {
    opened = std::make_shared<const PcdReader>(reader(index));
    kept_->keep(index, opened);
  }
  return std::make_unique<PcdScanReader>(std::move(opened), index, samples_);
}

void PcdScans::keepForNextOpen(std::size_t bytes) {
  kept_->allow(bytes);
}

std::vector<std::string> PcdScans::coordinateWarnings(double resolution) const {
  std::vector<SampledScan> sampled;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    std::vector<Eigen::Vector3d> points = samples_->of(i);
    if (points.empty()) continue;
    const PcdHeader header = reader(i).header();
    sampled.push_back({scans_[i].path, header.encoding == PcdEncoding::Ascii, std::move(points)});
  }
  return warningsOf(sampled, resolution);
}

std::vector<Eigen::Vector3d> PcdScans::sample(std::size_t index) const {
  std::vector<Eigen::Vector3d> points = samples_->of(index);
  if (frame_ == ScanFrame::Sensor)
    for (Eigen::Vector3d& point : points) point = scans_.at(index).pose * point;
  return points;
}

std::vector<std::filesystem::path> listScans(const std::vector<std::filesystem::path>& inputs) {
  std::vector<std::filesystem::path> scans;
  for (const std::filesystem::path& input : inputs) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(input, error);
    if (status.type() == std::filesystem::file_type::not_found) throw FileError(input, "does not exist");
    if (error) throw FileError(input, error.message());
    if (std::filesystem::is_directory(status)) {
      const std::vector<std::filesystem::path> found = scansIn(input);
      scans.insert(scans.end(), found.begin(), found.end());
    } else {
      scans.push_back(input);
    }
  }
  return scans;
}

FoundScans findScans(const std::vector<std::filesystem::path>& inputs, const FindScansOptions& options) {
  const std::vector<std::filesystem::path> paths = listScans(inputs);
  std::vector<std::string> warnings;
  warnOfScansGivenTwice(paths, warnings);
  std::vector<PcdReader> opened;
  std::vector<ScanPose> checked;
  for (const std::filesystem::path& path : paths) {
    PcdReader reader = openScan(path);
    checked.push_back(scanPose(reader));
    if (opened.size() < kMaxOpen) opened.push_back(std::move(reader));
  }
  AssignedPoses assigned = assignPoses(checked, options);
  warnings.insert(warnings.end(), assigned.warnings.begin(), assigned.warnings.end());
  std::vector<PcdReader> kept_readers;
  std::vector<ScanPose> kept;
  std::vector<PcdScan> scans;
  std::vector<Pose> as_read;
  for (std::size_t i = 0; i < checked.size(); ++i) {
    if (assigned.left_out[i]) continue;
    as_read.push_back(poseFault(assigned.as_read[i]).empty() ? normalised(assigned.as_read[i]) : Pose());
    kept.push_back(checked[i]);
    scans.push_back({checked[i].path, Pose(), assigned.times[i]});
    if (i < opened.size()) kept_readers.push_back(std::move(opened[i]));
  }
  if (options.frame == ScanFrame::Map) dropUnneededRotations(kept, warnings);
  const PoseDiagnosis diagnosis = diagnosePoses(kept);
  for (std::size_t i = 0; i < kept.size(); ++i) scans[i].pose = normalised(kept[i].pose);
  FoundScans found{PcdScans(std::move(scans), options.frame, std::move(kept_readers)),
                   std::move(warnings),
                   std::move(assigned.description),
                   std::move(assigned.without_pose),
                   std::move(as_read),
                   assigned.extrinsic};
  if (options.frame == ScanFrame::Map) return found;
  found.warnings.insert(found.warnings.end(), diagnosis.warnings.begin(), diagnosis.warnings.end());
  if (!diagnosis.same_pose.empty() && !standsStill(found.scans)) found.warnings.push_back(diagnosis.same_pose);
  return found;
}

FoundScans findScans(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& poses) {
  FindScansOptions options;
  options.poses = poses;
  return findScans(inputs, options);
}

}  // namespace gaussmap
