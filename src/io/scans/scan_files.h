// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "gaussmap/io/scans/file_scans.h"
#include "io/formats/scan_file.h"
#include "io/scans/open_scan_file.h"

namespace gaussmap::detail {

/// The files that were read last. Their pages stay in memory, because they may be read again, as after the check of
/// poses; those of older files are released. So memory does not grow with the number of files. Thread-safe.
class RecentFiles {
 public:
  /// Notes that a scan with this many points was read.
  void add(const std::shared_ptr<const ScanFile>& file, std::size_t points);

 private:
  std::mutex mutex_;
  std::size_t points_ = 0;
  std::deque<std::pair<std::shared_ptr<const ScanFile>, std::size_t>> files_;
};

/// The files of a list of scans. The number of files that stay open is limited; the others are opened again when they
/// are needed.
class ScanFiles {
 public:
  explicit ScanFiles(OpenOptions options) : options_(std::move(options)) {}

  struct Added {
    std::size_t number;
    std::shared_ptr<const ScanFile> file;
  };
  /// Opens a file, if it is not open yet. Throws FileError. Not thread-safe.
  Added add(const std::filesystem::path& path);
  /// Notes that a scan with this many points was read. See RecentFiles.
  void noteRead(const std::shared_ptr<const ScanFile>& file, std::size_t points) { recent_.add(file, points); }
  /// Returns a file by its number. Thread-safe. Throws FileError if the file has to be opened again and is gone.
  std::shared_ptr<const ScanFile> file(std::size_t number) const;

 private:
  OpenOptions options_;
  std::vector<std::filesystem::path> paths_;
  std::vector<std::shared_ptr<const ScanFile>> open_;  // the first files
  std::map<std::filesystem::path, std::size_t> numbers_;
  RecentFiles recent_;
};

/// Readers that have their points in memory, until they are taken. Thread-safe.
class KeptReaders {
 public:
  using Reader = std::shared_ptr<const ScanReader>;

  /// Sets the number of bytes that the points of further readers may take.
  void allow(std::size_t bytes);
  /// Returns the reader of a scan and stops keeping it; nullptr if the scan has no kept reader.
  Reader take(std::size_t scan);
  /// Keeps the reader of a scan whose points take this many bytes, if the limit allows it.
  void keep(std::size_t scan, const Reader& reader, std::size_t bytes);

 private:
  std::mutex mutex_;
  std::size_t budget_ = 0;
  std::map<std::size_t, Reader> readers_;
};

}  // namespace gaussmap::detail
