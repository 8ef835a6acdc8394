// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>

#include "gaussmap/core/error.h"
#include "io/bags/recording.h"
#include "io/files/natural_order.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";
constexpr std::size_t kLongestMetadata = std::size_t{16} << 20;

/// Removes .zstd or .zst from a name.
std::string withoutCompression(std::string name) {
  for (const std::string_view ending : {".zstd", ".zst"})
    if (endsWith(name, ending)) return name.substr(0, name.size() - ending.size());
  return name;
}

/// Returns the regular files that are not hidden.
std::vector<fs::path> filesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && entry->path().filename().string().front() != '.')
      files.push_back(entry->path());
  }
  if (error) throw FileError(folder, "cannot be read: " + error.message());
  return files;
}

std::string metadataOf(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_regular_file(folder / kMetadata, error)) return "";
  const std::uintmax_t bytes = fs::file_size(folder / kMetadata, error);
  std::ifstream file(folder / kMetadata, std::ios::binary);
  std::string text(error ? 0 : static_cast<std::size_t>(std::min<std::uintmax_t>(bytes, kLongestMetadata)), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return text;
}

/// Returns the names of recordings in the metadata, without their folders. This needs no parser of YAML: a name has no
/// blanks or quotes, or it is not found and all files of the folder are used.
std::set<std::string> namesIn(const std::string& metadata) {
  std::set<std::string> names;
  constexpr std::string_view kSeparators = " \t\r\n\"'/,[]{}";
  for (std::size_t begin = 0; begin < metadata.size();) {
    const std::size_t end = std::min(metadata.find_first_of(kSeparators, begin), metadata.size());
    if (end > begin && end - begin < 1000) {
      const std::string word = metadata.substr(begin, end - begin);
      if (hasRecordingName(word)) names.insert(word);
    }
    begin = end + 1;
  }
  return names;
}

/// `ros2 bag play` expands a compressed file beside it. Then both are there, and the expanded file is used.
void dropTwins(std::vector<fs::path>& files, std::vector<std::string>& warnings) {
  std::set<std::string> names;
  for (const fs::path& file : files) names.insert(file.filename().string());
  files.erase(std::remove_if(files.begin(), files.end(),
                             [&](const fs::path& file) {
                               const std::string name = file.filename().string(), plain = withoutCompression(name);
                               if (plain == name || names.count(plain) == 0) return false;
                               warnings.push_back(name + " is not read, because " + plain + " is there, too");
                               return true;
                             }),
              files.end());
}

/// Compares the files with the names in the metadata: other files are not read, and missing ones are reported.
void compareWithMetadata(const std::set<std::string>& names, std::vector<fs::path>& files,
                         std::vector<std::string>& warnings) {
  const auto named = [&](const fs::path& file) {
    const std::string name = file.filename().string(), plain = withoutCompression(name);
    return names.count(name) + names.count(plain) + names.count(plain + ".zstd") + names.count(plain + ".zst") > 0;
  };
  if (std::none_of(files.begin(), files.end(), named)) {
    warnings.push_back("metadata.yaml does not name the files of this folder: all of them are read");
    return;
  }
  std::set<std::string> present;
  std::vector<fs::path> kept;
  for (const fs::path& file : files) {
    if (!named(file)) {
      warnings.push_back(file.filename().string() + " is not read, because metadata.yaml does not name it");
      continue;
    }
    present.insert(withoutCompression(file.filename().string()));
    kept.push_back(file);
  }
  files = std::move(kept);
  for (const std::string& name : names)
    if (present.count(withoutCompression(name)) == 0)
      warnings.push_back(name + " is missing, but metadata.yaml names it");
}

}  // namespace

bool hasRecordingName(const fs::path& path) {
  const std::string name = path.filename().string(), plain = withoutCompression(name);
  return endsWith(plain, ".mcap") || endsWith(plain, ".db3") || endsWith(name, ".bag");
}

bool isRecordingFolder(const fs::path& folder) {
  try {
    if (isRosbag2Metadata(metadataOf(folder))) return true;
    const std::vector<fs::path> files = filesIn(folder);
    const auto belongs = [](const fs::path& file) {
      const std::string name = file.filename().string();
      return hasRecordingName(file) || endsWith(name, ".db3-wal") || endsWith(name, ".db3-shm") || name == kMetadata;
    };
    return std::any_of(files.begin(), files.end(), hasRecordingName) &&
           std::all_of(files.begin(), files.end(), belongs);
  } catch (const FileError&) {
    return false;
  }
}

RecordingFolder findRecordingFiles(const fs::path& folder) {
  RecordingFolder found;
  for (const fs::path& file : filesIn(folder))
    if (hasRecordingName(file)) found.files.push_back(file);
  if (found.files.empty())
    throw FileError(folder, "the folder has no recording (.mcap, .db3, .bag, or the first two with .zstd)");
  std::sort(found.files.begin(), found.files.end(), [](const fs::path& a, const fs::path& b) {
    return naturalLess(a.filename().string(), b.filename().string());
  });
  const std::string metadata = metadataOf(folder);
  const std::set<std::string> names = namesIn(metadata);
  dropTwins(found.files, found.warnings);
  if (isRosbag2Metadata(metadata))
    compareWithMetadata(names, found.files, found.warnings);
  else
    found.warnings.push_back("the folder has no metadata.yaml of rosbag2: its " + std::to_string(found.files.size()) +
                             (found.files.size() == 1 ? " file is" : " files are") + " read as one recording");
  return found;
}

}  // namespace gaussmap::detail
