// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/scans/pose_file.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "io/files/mapped_file.h"
#include "io/files/text.h"
#include "io/scans/pose_text.h"
#include "io/scans/scan_names.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Returns true if no field of the first line is a number: the line names the columns.
bool isHeader(const PoseText& text) {
  const std::vector<std::string_view> fields = fieldsOf(text, text.lines.front().text, false);
  double ignored = 0.0;
  std::size_t numbers = 0;
  for (const std::string_view field : fields) numbers += parseNumber(field, ignored) ? 1 : 0;
  return numbers == 0 && (fields.size() > 2 || countNames(text.lines.front().text) > 2);
}

/// Returns the layout that a comment before the poses gives; nullopt if no comment names the columns.
NamedLayout layoutOfComments(const PoseText& text) {
  const std::size_t width = fieldsOf(text, text.lines.front().text).size();
  for (auto comment = text.comments.rbegin(); comment != text.comments.rend(); ++comment) {
    std::string_view names = comment->text;
    for (int part = 0; part < 2; ++part) {  // the whole comment, then what follows a colon: "# format: time x y z ..."
      NamedLayout named = layoutOfNames(names);
      if (named.layout && countNames(names) == width) return named;
      const std::size_t colon = names.find(':');
      if (colon == std::string_view::npos) break;
      names.remove_prefix(colon + 1);
    }
  }
  return {};
}

/// The kind of a table whose columns have names.
PoseFormat formatOf(const PoseLayout& layout) {
  using C = PoseColumn;
  PoseLayout tum, euroc;
  tum.columns = {C::Time, C::X, C::Y, C::Z, C::QX, C::QY, C::QZ, C::QW};
  euroc.columns = {C::Time, C::X, C::Y, C::Z, C::QW, C::QX, C::QY, C::QZ};
  if (layout.columns == tum.columns) return PoseFormat::Tum;
  const std::string text = layout.text();
  return text == euroc.text() && layout.unit.value_or(TimeUnit::Nanoseconds) == TimeUnit::Nanoseconds
             ? PoseFormat::EuRoc
             : PoseFormat::Table;
}

PoseFile readTable(const PoseText& text, const PoseLayout& layout, std::size_t first, PoseFormat format) {
  PoseFile file = readPoseTable(text, layout, first);
  file.format = format;
  file.layout = layout.text();
  const auto pose = std::find_if(layout.columns.begin(), layout.columns.end(),
                                 [](PoseColumn column) { return column >= PoseColumn::X; });
  if (std::find(pose, layout.columns.end(), PoseColumn::Index) != layout.columns.end()) file.indices_may_be_ids = true;
  if (layout.columns.front() == PoseColumn::Key) {  // now it is known what the key is
    const PoseFile::Entry& entry = file.entries.front();
    file.layout.replace(0, 3, file.by_name ? "name" : entry.time ? "time" : "index");
  }
  return file;
}

PoseFile readNamedTable(const PoseText& text, const std::string& columns) {
  const bool has_header = isHeader(text);
  if (columns.empty()) {
    if (!has_header) {
      if (const NamedLayout named = layoutOfComments(text); named.layout && !named.lacks_unit)
        return readTable(text, *named.layout, 0, PoseFormat::Table);
      text.fail(text.lines.front().number, "no line with the names of the columns");
    }
    const NamedLayout named = layoutOfNames(text.lines.front().text);
    if (named.lacks_unit) text.fail(text.lines.front().number, named.problem);
    if (!named.layout)
      text.fail(text.lines.front().number, "the names of the columns do not give a pose: " + named.problem +
                                               "; name the columns with --pose-format \"time x y z qx qy qz qw\"");
    return readTable(text, *named.layout, 1, formatOf(*named.layout));
  }
  const NamedLayout named = layoutOfNames(columns);
  if (!named.problem.empty())
    throw FileError(text.path, "the columns '" + columns + "' do not give a pose: " + named.problem);
  return readTable(text, *named.layout, has_header ? 1 : 0, PoseFormat::Table);
}

/// Calls text.fail() for images.txt of COLMAP: `id qw qx qy qz tx ty tz camera name`, from the world to the camera.
void requireNotColmap(const PoseText& text) {
  const auto isHeading = [](const TextLine& comment) {
    return comment.text.find("IMAGE_ID") != std::string_view::npos &&
           comment.text.find("CAMERA_ID") != std::string_view::npos;
  };
  bool is_colmap = std::any_of(text.comments.begin(), text.comments.end(), isHeading);
  const std::vector<std::string_view> words = splitWords(text.lines.front().text);
  double ignored = 0.0;
  if (words.size() == 10 && !parseNumber(words[9], ignored)) {
    std::vector<double> v = numbersOf({words.begin(), words.end() - 1}, 0);
    is_colmap = is_colmap || (v.size() == 9 && v[0] == std::floor(v[0]) && v[8] == std::floor(v[8]) &&
                              std::abs(Eigen::Vector4d(v[1], v[2], v[3], v[4]).norm() - 1.0) < kQuaternionTolerance);
  }
  if (is_colmap)
    text.fail(text.lines.front().number,
              "looks like images.txt of COLMAP, whose poses go from the world to the camera and have no unit. Write "
              "the poses from the camera to the world, in metres, as 'name x y z qx qy qz qw'");
}

PoseFile readAutomatic(const PoseText& text) {
  requireNotColmap(text);
  if (isPoseGraph(text)) return readPoseGraph(text);
  if (isHeader(text)) return readNamedTable(text, "");
  if (isBlocks(text)) return readPoseBlocks(text);
  if (const NamedLayout named = layoutOfComments(text); named.layout) {
    if (named.lacks_unit) text.fail(text.lines.front().number, named.problem);
    return readTable(text, *named.layout, 0, formatOf(*named.layout));
  }
  const InferredLayout inferred = inferLayout(text, 0);
  PoseFile file = readTable(text, inferred.layout, 0, inferred.format);
  file.indices_may_be_ids = file.indices_may_be_ids || inferred.index_behind;
  return file;
}

/// Names are compared with their last folder, as in 000000/cloud.pcd.
void requireDifferentNames(const PoseFile& file) {
  std::unordered_map<std::string, std::size_t> lines;
  for (const PoseFile::Entry& entry : file.entries) {
    const std::string name = folderAndFileName(entry.name);
    const auto [first, is_new] = lines.emplace(name, entry.line);
    if (!is_new)
      throw FileError(file.path, "line " + std::to_string(entry.line) + ": " + quote(name) +
                                     " already has a pose in line " + std::to_string(first->second));
  }
}

}  // namespace

PoseFile readPoseFile(const std::filesystem::path& path, PoseFormat format, const std::string& columns) {
  const MappedFile mapped(path);
  const PoseText text = splitPoseText(path, mapped.bytes());
  const auto read = [&]() -> PoseFile {
    switch (format) {
      case PoseFormat::Automatic:
        return readAutomatic(text);
      case PoseFormat::G2o:
        return readPoseGraph(text);
      case PoseFormat::Table:
        return readNamedTable(text, columns);
      case PoseFormat::Matrix4:
        if (isBlocks(text)) return readPoseBlocks(text);
        break;
      default:
        break;
    }
    const std::size_t first = isHeader(text) ? 1 : 0;
    if (format == PoseFormat::XyzRpyDegrees || format == PoseFormat::XyzRpyRadians) {
      NamedLayout named = first > 0 ? layoutOfNames(text.lines.front().text) : layoutOfComments(text);
      if (named.layout && named.layout->rotation == RotationKind::RollPitchYaw) {
        named.layout->degrees = format == PoseFormat::XyzRpyDegrees;
        return readTable(text, *named.layout, first, format);
      }
    }
    if (first >= text.lines.size()) throw FileError(path, "no pose in this file, only a header line");
    return readTable(text, layoutOfFormat(text, format, first), first, format);
  };
  PoseFile file = read();
  mapped.requireWhole();
  file.path = path;
  if (isPoseGraph(text)) file.format = PoseFormat::G2o;
  if (file.format == PoseFormat::Automatic) file.format = PoseFormat::Matrix4;
  if (file.by_name) requireDifferentNames(file);
  return file;
}

}  // namespace gaussmap
