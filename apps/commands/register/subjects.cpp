// SPDX-License-Identifier: BSD-3-Clause
#include "commands/register/subjects.h"

#include "common/report.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "io/scans/open_scan_file.h"

namespace gaussmap::app {
namespace {

void addScansOf(const std::filesystem::path& path, const detail::OpenOptions& options, std::vector<Subject>& subjects) {
  const auto file = detail::openScanFile(path, options);
  for (std::size_t i = 0; i < file->size(); ++i) {
    detail::FileScanInfo info = file->info(i);
    subjects.push_back({path, std::move(info.name), i, false, info.pose, info.time});
  }
  for (const std::string& warning : file->warnings()) warn(path.string() + ": " + warning);
}

}  // namespace

std::vector<Subject> subjectsIn(const std::vector<std::filesystem::path>& files, const FindScansOptions& options) {
  const detail::OpenOptions opening = detail::openOptions(options);
  std::vector<Subject> subjects;
  for (const std::filesystem::path& path : files) {
    try {
      if (isMap(path))
        subjects.push_back({path, "", 0, true, Pose()});
      else
        addScansOf(path, opening, subjects);
    } catch (const FileError& error) {
      if (files.size() == 1) throw;
      subjects.push_back({path, "", 0, false, std::nullopt, std::nullopt, error.what()});
    }
  }
  return subjects;
}

}  // namespace gaussmap::app
