// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/scans/pose_file.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <sstream>
#include <unordered_map>

#include "io/files/mapped_file.h"
#include "io/files/text.h"
#include "io/scans/scan_names.h"

namespace gaussmap {
using namespace detail;

namespace {

enum class Layout { Unknown, Tum, Kitti, NameTum, NameKitti };

constexpr std::size_t kTumNumbers = 7;
constexpr std::size_t kKittiNumbers = 12;
constexpr double kRotationTolerance = 1e-3;

std::string fileName(const PoseFile::Entry& entry) {
  return std::filesystem::path(entry.name).filename().string();
}

/// Returns the last folder and the file name: 000000/cloud.pcd.
std::string folderAndFileName(const std::filesystem::path& path) {
  const std::filesystem::path normal = path.lexically_normal();
  return (normal.parent_path().filename() / normal.filename()).string();
}

class PoseFileParser {
 public:
  PoseFileParser(const std::filesystem::path& path, std::string_view text) : path_(path), rest_(text) {}

  PoseFile parse() {
    PoseFile file;
    file.path = path_;
    if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) rest_.remove_prefix(kByteOrderMark.size());
    for (line_ = 1; !rest_.empty(); ++line_) {
      const std::string_view text = takeLine(rest_);
      const std::vector<std::string_view> words = splitWords(text);
      if (words.empty() || words.front().front() == '#') continue;
      file.entries.push_back(parseLine(words));
    }
    file.by_name = layout_ == Layout::NameTum || layout_ == Layout::NameKitti;
    if (file.entries.empty()) throw FileError(path_, "no pose in this file");
    if (file.by_name) requireDifferentNames(file);
    return file;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(path_, "line " + std::to_string(line_) + ": " + what);
  }

  PoseFile::Entry parseLine(const std::vector<std::string_view>& words) {
    // Numbers are read from the right, because a name may contain blanks.
    std::vector<double> numbers(words.size());
    std::size_t name_words = words.size();
    while (name_words > 0 && parseNumber(words[name_words - 1], numbers[name_words - 1])) --name_words;

    const Layout layout = layoutOf(words, name_words);
    if (layout_ != Layout::Unknown && layout != layout_) fail("the line has another layout than the lines before it");
    layout_ = layout;

    const bool is_matrix = layout == Layout::Kitti || layout == Layout::NameKitti;
    const std::size_t first = words.size() - (is_matrix ? kKittiNumbers : kTumNumbers);
    PoseFile::Entry entry;
    entry.line = line_;
    if (first > 0) {
      const std::string_view last = words[first - 1];
      entry.name =
          std::string(words.front().data(), static_cast<std::size_t>(last.data() + last.size() - words.front().data()));
    }
    entry.pose = is_matrix ? poseFromMatrix(&numbers[first]) : poseFromQuaternion(&numbers[first]);
    return entry;
  }

  Layout layoutOf(const std::vector<std::string_view>& words, std::size_t name_words) const {
    const std::size_t numbers = words.size() - name_words;
    if (name_words == 0 && numbers == 1 + kTumNumbers) return Layout::Tum;
    if (name_words == 0 && numbers == kKittiNumbers) return Layout::Kitti;
    if (name_words == 0 && numbers == 1 + kKittiNumbers) return Layout::NameKitti;  // the scans' names are numbers
    if (name_words > 0 && numbers == kTumNumbers) return Layout::NameTum;
    if (name_words > 0 && numbers == kKittiNumbers) return Layout::NameKitti;
    std::string what = std::to_string(words.size()) + " words";
    if (name_words > 0) what += ", the last one that is not a number is " + quote(words[name_words - 1]);
    fail(what +
         ": a pose is 'time x y z qx qy qz qw' (TUM), the 12 numbers of a 3 x 4 matrix (KITTI), or a file name "
         "before 'x y z qx qy qz qw' or before the 12 numbers, with blanks between them");
  }

  Pose poseFromQuaternion(const double* v) const {
    Pose pose;
    pose.translation = {v[0], v[1], v[2]};
    pose.rotation = {v[6], v[3], v[4], v[5]};
    if (const std::string fault = poseFault(pose); !fault.empty()) fail(fault);
    return normalised(pose);
  }

  Pose poseFromMatrix(const double* v) const {
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(v);
    const Eigen::Matrix3d rotation = matrix.leftCols<3>();
    if (!matrix.allFinite()) fail("the matrix is not finite");
    const double error = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(error <= kRotationTolerance)) {
      std::ostringstream text;
      text << "the 3 x 3 part is not a rotation: R R' differs from the identity by " << error;
      fail(text.str());
    }
    if (rotation.determinant() < 0.0) fail("the 3 x 3 part is a reflection (determinant -1), not a rotation");
    Pose pose;
    pose.translation = matrix.col(3);
    pose.rotation = rotation;
    return normalised(pose);
  }

  void requireDifferentNames(const PoseFile& file) {
    // Names are compared with their last folder, as in 000000/cloud.pcd.
    std::unordered_map<std::string, std::size_t> lines;
    for (const PoseFile::Entry& entry : file.entries) {
      const auto [first, is_new] = lines.emplace(folderAndFileName(entry.name), entry.line);
      line_ = entry.line;
      if (!is_new)
        fail(quote(folderAndFileName(entry.name)) + " already has a pose in line " + std::to_string(first->second));
    }
  }

  const std::filesystem::path& path_;
  std::string_view rest_;
  std::size_t line_ = 0;
  Layout layout_ = Layout::Unknown;
};

/// Finds the entry of a scan by its name.
class NameIndex {
 public:
  explicit NameIndex(const PoseFile& file) {
    for (const PoseFile::Entry& entry : file.entries) {
      by_folder_.emplace(folderAndFileName(entry.name), &entry);
      const auto [place, is_new] = entries_.emplace(fileName(entry), &entry);
      if (!is_new) place->second = nullptr;  // only the folders tell these entries apart
    }
  }
  /// Finds the entry with the name of the folder and the file, of the file, or of the folder (000000/cloud.pcd).
  const PoseFile::Entry* find(const std::filesystem::path& scan) const {
    if (const auto found = by_folder_.find(folderAndFileName(scan)); found != by_folder_.end()) return found->second;
    for (const std::filesystem::path& name : {scan.filename(), scan.stem(), std::filesystem::path(scanStem(scan)),
                                              scan.lexically_normal().parent_path().filename()})
      if (const auto found = entries_.find(name.string()); found != entries_.end() && found->second != nullptr)
        return found->second;
    return nullptr;
  }

 private:
  std::unordered_map<std::string, const PoseFile::Entry*> by_folder_;
  std::unordered_map<std::string, const PoseFile::Entry*> entries_;
};

std::vector<Pose> posesByName(const PoseFile& file, const NameIndex& index,
                              const std::vector<std::filesystem::path>& scans) {
  std::vector<Pose> poses;
  std::unordered_map<const PoseFile::Entry*, std::filesystem::path> users;
  for (const std::filesystem::path& scan : scans) {
    const PoseFile::Entry* const entry = index.find(scan);
    if (!entry) throw FileError(file.path, "no pose for the scan " + folderAndFileName(scan));
    const auto [user, is_new] = users.emplace(entry, scan);
    if (!is_new)
      throw FileError(file.path, "line " + std::to_string(entry->line) + ": " + quote(entry->name) + " names both " +
                                     user->second.string() + " and " + scan.string());
    poses.push_back(entry->pose);
  }
  return poses;
}

}  // namespace

PoseFile readPoseFile(const std::filesystem::path& path) {
  const MappedFile file(path);
  PoseFile poses = PoseFileParser(path, file.bytes()).parse();
  file.requireWhole();
  return poses;
}

std::vector<Pose> posesForScans(const PoseFile& file, const std::vector<std::filesystem::path>& scans) {
  const NameIndex index(file);
  bool by_name = file.by_name;
  if (!by_name && !scans.empty()) {
    by_name = true;
    for (const std::filesystem::path& scan : scans) by_name = by_name && index.find(scan) != nullptr;
  }
  if (by_name) return posesByName(file, index, scans);

  if (file.entries.size() != scans.size())
    throw FileError(file.path, std::to_string(file.entries.size()) + " poses for " + std::to_string(scans.size()) +
                                   " scans: give one line per scan in the order of the scans, or start each line with "
                                   "the file name of its scan");
  std::vector<Pose> poses;
  for (const PoseFile::Entry& entry : file.entries) poses.push_back(entry.pose);
  return poses;
}

}  // namespace gaussmap
