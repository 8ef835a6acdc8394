// SPDX-License-Identifier: BSD-3-Clause
// Which files a list of inputs means.
#include <algorithm>
#include <map>
#include <system_error>

#include "gaussmap/io/scans/file_scans.h"
#include "io/files/natural_order.h"
#include "io/formats/message_file.h"
#include "io/scans/list_scans.h"
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
      if (!scanExtension(file->path().filename()).empty())
        return ", but its subdirectories have some: give them, for example " + (directory / "*").string() + "/" +
               file->path().filename().string();
  }
  return "";
}

/// Returns what to write if the scans may be texts. A directory can hold texts of other kinds, such as poses.
std::string hintOfTexts(const std::filesystem::path& directory) {
  std::error_code error;
  for (std::filesystem::directory_iterator file(directory, error), end; !error && file != end; file.increment(error)) {
    const std::string extension = file->path().extension().string();
    if (isTextName(file->path()))
      return "; if the " + extension + " files are scans, give them: " + (directory / ("*" + extension)).string();
  }
  return "";
}

/// The files of scans in a directory, per extension.
using FilesPerKind = std::map<std::string, std::vector<std::filesystem::path>>;

FilesPerKind filesIn(const std::filesystem::path& directory) {
  FilesPerKind files;
  std::error_code error;
  std::filesystem::directory_iterator entry(directory, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    // A broken link or a pipe stays in the list: the reader reports what is wrong with it.
    std::error_code ignored;
    const std::string extension = scanExtension(entry->path().filename());
    if (!extension.empty() && !entry->is_directory(ignored)) files[extension].push_back(entry->path());
  }
  if (error) throw FileError(directory, "cannot be listed: " + error.message());
  return files;
}

/// ".las (3 files), .ply (1 file)"
std::string countsOf(const FilesPerKind& files) {
  std::string text;
  for (const auto& [extension, paths] : files)
    text += (text.empty() ? "" : ", ") + extension + " (" + std::to_string(paths.size()) +
            (paths.size() == 1 ? " file)" : " files)");
  return text;
}

/// Returns the files of one kind. PCD files come before all others, then a warning says which files are not read.
std::vector<std::filesystem::path> scansIn(const std::filesystem::path& directory, std::vector<std::string>& warnings) {
  FilesPerKind files = filesIn(directory);
  if (files.empty())
    throw FileError(directory,
                    "no file of scans in this directory" + hintOfSubfolders(directory) + hintOfTexts(directory));
  const auto pcds = files.find(".pcd");
  if (pcds == files.end() && files.size() > 1)
    throw FileError(directory, "holds files of several kinds: " + countsOf(files) +
                                   "; give the files to read, for example " +
                                   (directory / ("*" + files.begin()->first)).string());
  if (pcds != files.end() && files.size() > 1)
    warnings.push_back(directory.string() + " holds files of several kinds: " + countsOf(files) +
                       "; only the .pcd files are read");
  std::vector<std::filesystem::path> scans = std::move((pcds != files.end() ? pcds : files.begin())->second);
  std::sort(scans.begin(), scans.end(),
            [](const auto& a, const auto& b) { return naturalLess(a.filename().string(), b.filename().string()); });
  return scans;
}

}  // namespace

std::vector<std::filesystem::path> listScans(const std::vector<std::filesystem::path>& inputs) {
  std::vector<std::string> ignored;
  return detail::listScans(inputs, ignored);
}

std::vector<std::filesystem::path> detail::listScans(const std::vector<std::filesystem::path>& inputs,
                                                     std::vector<std::string>& warnings) {
  std::vector<std::filesystem::path> scans;
  for (const std::filesystem::path& input : inputs) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(input, error);
    if (status.type() == std::filesystem::file_type::not_found) throw FileError(input, "does not exist");
    if (error) throw FileError(input, error.message());
    if (std::filesystem::is_directory(status) && !isMessageFile(input)) {
      const std::vector<std::filesystem::path> found = scansIn(input, warnings);
      scans.insert(scans.end(), found.begin(), found.end());
    } else {
      scans.push_back(input);
    }
  }
  return scans;
}

}  // namespace gaussmap
