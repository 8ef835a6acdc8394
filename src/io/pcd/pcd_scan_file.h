// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// ScanFile::poseSource() of PCD files.
inline constexpr const char* kViewpointSource = "VIEWPOINT of each scan";

/// A PCD file as a file with one scan.
class PcdScanFile : public ScanFile {
 public:
  explicit PcdScanFile(PcdReader reader) : reader_(std::move(reader)) {}

  /// Returns a reader with access to the header, the records and the columns.
  PcdReader reader() const { return reader_.sameFile(); }

  std::string kind() const override;
  std::size_t size() const override { return 1; }
  FileScanInfo info(std::size_t scan) const override;
  std::unique_ptr<ScanReader> open(std::size_t scan) const override;
  std::string poseSource() const override { return kViewpointSource; }
  std::size_t memoryOf(std::size_t scan) const override;
  void releasePages() const override { reader_.releasePages(); }

 private:
  PcdReader reader_;
};

/// Opens a PCD file. Throws FileError like PcdReader, and if the file holds the Gaussians of a map.
std::unique_ptr<PcdScanFile> openPcd(const std::filesystem::path& path);

}  // namespace gaussmap::detail
