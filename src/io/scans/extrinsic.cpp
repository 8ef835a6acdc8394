// SPDX-License-Identifier: BSD-3-Clause
// Files with the pose of a sensor on its vehicle.
#include <algorithm>

#include "gaussmap/io/scans/file_scans.h"
#include "io/files/mapped_file.h"
#include "io/files/text.h"
#include "io/scans/pose_text.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Blanks in place of what stands between numbers.
std::string numbersOnly(std::string_view text) {
  std::string plain(text);
  for (char& c : plain)
    if (c == ',' || c == ';' || c == '[' || c == ']' || c == '\n') c = ' ';
  return plain;
}

std::optional<Pose> poseOfNumbers(const PoseText& text, std::size_t line, const std::vector<double>& numbers) {
  if (numbers.size() == 12 || numbers.size() == 16) {
    if (numbers.size() == 16)
      if (const std::string fault = lastRowFault(numbers.data()); !fault.empty()) text.fail(line, fault);
    return poseOfMatrix(text, line, numbers.data());
  }
  if (numbers.size() != 7) return std::nullopt;
  const Pose pose{{numbers[0], numbers[1], numbers[2]}, Pose::Rotation(numbers[6], numbers[3], numbers[4], numbers[5])};
  if (const std::string fault = poseFault(pose); !fault.empty()) text.fail(line, fault);
  return normalised(pose);
}

/// Returns the text behind a key such as "Tr:" or "Tr"; nullopt if the line has another one.
std::optional<std::string_view> valueOf(std::string_view line, std::string_view key) {
  if (line.substr(0, key.size()) != key) return std::nullopt;
  line.remove_prefix(key.size());
  const bool has_blank = !line.empty() && isBlank(line.front());
  while (!line.empty() && isBlank(line.front())) line.remove_prefix(1);
  if (!line.empty() && line.front() == ':') return line.substr(1);
  if (!has_blank || line.empty()) return std::nullopt;
  return line;
}

std::vector<double> numbersInText(std::string_view text) {
  const std::string plain = numbersOnly(text);
  return numbersOf(splitWords(plain), 0);
}

/// Reads the lines "R:" and "T:" of the raw data of KITTI. The name of the file says what they mean.
std::optional<Extrinsic> readRotationAndTranslation(const PoseText& text) {
  std::vector<double> rotation, translation;
  std::size_t number = 0;
  for (const TextLine& line : text.lines) {
    if (const auto value = valueOf(line.text, "R")) rotation = numbersInText(*value), number = line.number;
    if (const auto value = valueOf(line.text, "T")) translation = numbersInText(*value);
  }
  if (rotation.size() != 9 || translation.size() != 3) return std::nullopt;
  std::vector<double> matrix;
  for (std::size_t row = 0; row < 3; ++row) {
    matrix.insert(matrix.end(), rotation.begin() + static_cast<std::ptrdiff_t>(3 * row),
                  rotation.begin() + static_cast<std::ptrdiff_t>(3 * row + 3));
    matrix.push_back(translation[row]);
  }
  Extrinsic extrinsic;
  extrinsic.file = text.path;
  extrinsic.pose = poseOfMatrix(text, number, matrix.data());
  const std::string name = text.path.filename().string();
  extrinsic.turns_map = name.find("velo_to_cam") != std::string::npos;
  if (name.find("imu_to_velo") != std::string::npos) extrinsic.pose = extrinsic.pose.inverse();
  return extrinsic;
}

}  // namespace

Extrinsic readExtrinsic(const std::filesystem::path& file) {
  const MappedFile mapped(file);
  const PoseText text = splitPoseText(file, mapped.bytes());
  Extrinsic extrinsic;
  extrinsic.file = file;
  bool has_keys = false;
  for (const TextLine& line : text.lines) {
    for (const char* const key : {"Tr", "Tr_velo_to_cam", "Tr_velo_cam"}) {
      const std::optional<std::string_view> value = valueOf(line.text, key);
      if (!value) continue;
      const std::vector<double> numbers = numbersInText(*value);
      if (numbers.size() != 12)
        text.fail(line.number, std::string(key) + ": expected the 12 numbers of a 3 x 4 matrix");
      extrinsic.pose = *poseOfNumbers(text, line.number, numbers);
      extrinsic.turns_map = true;
      return extrinsic;
    }
    has_keys = has_keys || line.text.find(':') != std::string_view::npos;
  }
  if (const std::optional<Extrinsic> found = readRotationAndTranslation(text)) return *found;
  std::string_view all(text.lines.front().text.data(),
                       static_cast<std::size_t>(text.lines.back().text.data() + text.lines.back().text.size() -
                                                text.lines.front().text.data()));
  std::size_t number = text.lines.front().number;
  if (has_keys) {  // the matrix T_BS of a sensor.yaml: data: [...]
    const std::size_t matrix = all.find("T_BS"),
                      data = all.find("data:", matrix == std::string_view::npos ? 0 : matrix);
    const std::size_t open = data == std::string_view::npos ? data : all.find('[', data);
    const std::size_t close = open == std::string_view::npos ? open : all.find(']', open);
    if (matrix == std::string_view::npos || close == std::string_view::npos)
      throw FileError(file, "no line 'Tr:' (KITTI), no lines 'R:' and 'T:' (KITTI raw) and no matrix T_BS (EuRoC)");
    number += static_cast<std::size_t>(std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(open), '\n'));
    all = all.substr(open, close - open);
  }
  const std::optional<Pose> pose = poseOfNumbers(text, number, numbersInText(all));
  if (!pose)
    throw FileError(file, "no extrinsic: expected x y z qx qy qz qw, the 12 or 16 numbers of a matrix, or a calib.txt");
  mapped.requireWhole();
  extrinsic.pose = *pose;
  return extrinsic;
}

}  // namespace gaussmap
