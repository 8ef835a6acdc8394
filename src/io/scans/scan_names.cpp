// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/scan_names.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

std::string lowerExtension(const std::filesystem::path& name) {
  return lowerCase(name.extension().string());
}

/// Removes the extension .gz of a name like scan.pcd.gz.
std::filesystem::path withoutGz(const std::filesystem::path& name) {
  return lowerExtension(name) == ".gz" && lowerExtension(name.stem()) == ".pcd" ? name.stem() : name;
}

/// Returns the name of a copy in PCD format.
std::filesystem::path copyName(const std::filesystem::path& scan) {
  std::filesystem::path name = withoutGz(scan.filename());
  if (const std::string extension = scanExtension(name); !extension.empty() && extension != ".pcd")
    name.replace_extension(".pcd");
  return name;
}

/// Returns the name of the folder of a scan; empty if it has none.
std::filesystem::path folderName(const std::filesystem::path& scan) {
  const std::filesystem::path folder = scan.lexically_normal().parent_path().filename();
  return folder == "." || folder == ".." ? std::filesystem::path() : folder;
}

}  // namespace

std::string scanExtension(const std::filesystem::path& name) {
  static const std::set<std::string> kExtensions = {".pcd", ".ply", ".las", ".laz",  ".e57", ".pts",
                                                    ".ptx", ".xyz", ".bin", ".mcap", ".db3", ".bag"};
  if (name.empty() || name.string().front() == '.') return "";
  const std::string extension = lowerExtension(withoutGz(name));
  return kExtensions.count(extension) > 0 ? extension : "";
}

bool isTextName(const std::filesystem::path& name) {
  const std::string extension = lowerExtension(name);
  return extension == ".txt" || extension == ".csv" || extension == ".asc";
}

std::string scanStem(const std::filesystem::path& scan) {
  const std::filesystem::path name = withoutGz(scan.filename());
  return scanExtension(name).empty() ? name.string() : name.stem().string();
}

std::vector<std::filesystem::path> scanCopies(const std::vector<std::filesystem::path>& scans) {
  std::set<std::filesystem::path> names;
  for (const std::filesystem::path& scan : scans) names.insert(copyName(scan));
  std::vector<std::filesystem::path> copies;
  copies.reserve(scans.size());
  for (const std::filesystem::path& scan : scans) {
    const std::filesystem::path name = copyName(scan), folder = folderName(scan);
    copies.push_back(names.size() == scans.size() || folder.empty() ? name : folder / name);
  }
  return copies;
}

std::vector<std::string> scanNames(const std::vector<std::filesystem::path>& scans) {
  std::set<std::filesystem::path> files;
  for (const std::filesystem::path& scan : scans) files.insert(scan.filename());
  std::vector<std::string> names;
  names.reserve(scans.size());
  for (const std::filesystem::path& scan : scans) {
    const std::filesystem::path folder = folderName(scan);
    const bool is_enough = files.size() == scans.size() || folder.empty();
    names.push_back((is_enough ? scan.filename() : folder / scan.filename()).string());
  }
  return names;
}

std::string folderAndFileName(const std::filesystem::path& path) {
  return (folderName(path) / path.filename()).string();
}

}  // namespace gaussmap::detail
