// SPDX-License-Identifier: BSD-3-Clause
// Which files a list of inputs means.
#include <algorithm>
#include <system_error>

#include "gaussmap/io/scans/file_scans.h"
#include "io/scans/scan_names.h"

namespace gaussmap {
using namespace detail;

namespace {

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

}  // namespace

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

}  // namespace gaussmap
