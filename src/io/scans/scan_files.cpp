// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/scan_files.h"

#include <utility>

namespace gaussmap::detail {
namespace {

// Maximum number of files that stay open: each takes a memory map and a few kilobytes.
constexpr std::size_t kMaxOpen = 1024;

}  // namespace

ScanFiles::Added ScanFiles::add(const std::filesystem::path& path) {
  if (const auto known = numbers_.find(path); known != numbers_.end()) return {known->second, file(known->second)};
  Added added{paths_.size(), openScanFile(path, options_)};
  std::size_t points = 0;
  for (std::size_t i = 0; i < added.file->size(); ++i) points += added.file->info(i).points;
  recent_.add(added.file, points);  // opening a text reads the whole file
  numbers_.emplace(path, added.number);
  paths_.push_back(path);
  if (open_.size() < kMaxOpen) open_.push_back(added.file);
  return added;
}

std::shared_ptr<const ScanFile> ScanFiles::file(std::size_t number) const {
  return number < open_.size() ? open_[number] : openScanFile(paths_.at(number), options_);
}

void RecentFiles::add(const std::shared_ptr<const ScanFile>& file, std::size_t points) {
  constexpr std::size_t kMostRecentPoints = std::size_t{1} << 20;  // 16 to 32 MiB
  constexpr std::size_t kMostRecentFiles = 64;
  const std::lock_guard<std::mutex> lock(mutex_);
  files_.emplace_back(file, points);
  points_ += points;
  while (points_ > kMostRecentPoints || files_.size() > kMostRecentFiles) {
    points_ -= files_.front().second;
    files_.front().first->releasePages();
    files_.pop_front();
  }
}

void KeptReaders::allow(std::size_t bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  budget_ = bytes;
}

KeptReaders::Reader KeptReaders::take(std::size_t scan) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = readers_.find(scan);
  if (found == readers_.end()) return nullptr;
  Reader reader = std::move(found->second);
  readers_.erase(found);
  return reader;
}

void KeptReaders::keep(std::size_t scan, const Reader& reader, std::size_t bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (bytes <= budget_ && readers_.emplace(scan, reader).second) budget_ -= bytes;
}

}  // namespace gaussmap::detail
