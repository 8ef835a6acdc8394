// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/scans/file_scans.h"

#include <algorithm>
#include <utility>

#include "io/pcd/pcd_scan_file.h"
#include "io/scans/coordinate_checks.h"
#include "io/scans/scan_files.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Reads a scan, and keeps some of its points for the checks of coordinates. At the end, pages of files are released,
/// so that the memory of a program does not grow with the number of scans.
class SampledReader : public ScanReader {
 public:
  SampledReader(std::shared_ptr<const ScanFile> file, std::shared_ptr<const ScanReader> reader, std::size_t scan,
                std::shared_ptr<CoordinateSamples> samples, std::shared_ptr<ScanFiles> files)
      : file_(std::move(file)),
        reader_(std::move(reader)),
        scan_(scan),
        samples_(std::move(samples)),
        files_(std::move(files)) {}
  ~SampledReader() override {
    if (file_) files_->noteRead(file_, reader_->size());
  }
  SampledReader(const SampledReader&) = delete;
  SampledReader& operator=(const SampledReader&) = delete;

  std::size_t size() const override { return reader_->size(); }
  int columns() const override { return reader_->columns(); }
  void read(std::size_t first, PointBlock<3>& block) const override {
    reader_->read(first, block);
    samples_->add(scan_, first, block, size());
  }
  void requireWhole() const override { reader_->requireWhole(); }
  std::vector<std::string> valueNames() const override { return reader_->valueNames(); }
  std::vector<double> values(const std::string& name) const override { return reader_->values(name); }

 private:
  std::shared_ptr<const ScanFile> file_;  // nullptr: the reader was kept
  std::shared_ptr<const ScanReader> reader_;
  std::size_t scan_;
  std::shared_ptr<CoordinateSamples> samples_;
  std::shared_ptr<ScanFiles> files_;
};

}  // namespace

FileScans::FileScans(std::vector<FileScan> scans, ScanFrame frame, const FileOptions& options)
    : FileScans(std::move(scans), frame, std::make_shared<ScanFiles>(OpenOptions{options, false, {}})) {}

FileScans::FileScans(std::vector<FileScan> scans, ScanFrame frame, std::shared_ptr<ScanFiles> files)
    : scans_(std::move(scans)),
      files_(std::move(files)),
      frame_(frame),
      samples_(std::make_shared<CoordinateSamples>(scans_.size())),
      kept_(std::make_shared<KeptReaders>()) {
  file_of_.reserve(scans_.size());
  for (const FileScan& scan : scans_) {
    const ScanFiles::Added added = files_->add(scan.path);
    if (scan.index >= added.file->size())
      throw FileError(scan.path, "no scan " + std::to_string(scan.index) + ": the file has " +
                                     std::to_string(added.file->size()) + " scans");
    file_of_.push_back(added.number);
  }
}

FileScans::~FileScans() = default;
FileScans::FileScans(FileScans&&) noexcept = default;
FileScans& FileScans::operator=(FileScans&&) noexcept = default;

ScanInfo FileScans::info(std::size_t index) const {
  const FileScan& scan = scans_.at(index);
  return {scan.path.string() + (scan.name.empty() ? "" : ": " + scan.name), scan.pose, scan.time};
}

std::unique_ptr<ScanReader> FileScans::open(std::size_t index) const {
  std::shared_ptr<const ScanReader> reader = kept_->take(index);
  std::shared_ptr<const ScanFile> file;
  if (!reader) {
    file = files_->file(file_of_.at(index));
    reader = file->open(scans_[index].index);
    if (const std::size_t bytes = file->memoryOf(scans_[index].index); bytes > 0) kept_->keep(index, reader, bytes);
  }
  return std::make_unique<SampledReader>(std::move(file), std::move(reader), index, samples_, files_);
}

std::string FileScans::kind(std::size_t index) const {
  return files_->file(file_of_.at(index))->kind();
}

std::string FileScans::coordinateSystem(std::size_t index) const {
  return files_->file(file_of_.at(index))->coordinateSystem();
}

std::optional<PcdReader> FileScans::pcd(std::size_t index) const {
  const std::shared_ptr<const ScanFile> file = files_->file(file_of_.at(index));
  const auto* const pcd_file = dynamic_cast<const PcdScanFile*>(file.get());
  return pcd_file == nullptr ? std::nullopt : std::optional(pcd_file->reader());
}

void FileScans::keepForNextOpen(std::size_t bytes) {
  kept_->allow(bytes);
}

std::vector<std::string> FileScans::coordinateWarnings(double resolution) const {
  std::vector<SampledScan> sampled;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    std::vector<Eigen::Vector3d> points = samples_->of(i);
    if (points.empty()) continue;
    const std::optional<PcdReader> reader = pcd(i);
    const bool is_ascii = reader && reader->header().encoding == PcdEncoding::Ascii;
    sampled.push_back({scans_[i].path, is_ascii, std::move(points)});
  }
  return warningsOf(sampled, resolution);
}

std::vector<Eigen::Vector3d> FileScans::sample(std::size_t index) const {
  std::vector<Eigen::Vector3d> points = samples_->of(index);
  if (frame_ == ScanFrame::Sensor)
    for (Eigen::Vector3d& point : points) point = scans_.at(index).pose * point;
  return points;
}

}  // namespace gaussmap
