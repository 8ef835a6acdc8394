// SPDX-License-Identifier: BSD-3-Clause
// Pose files with several lines per pose: matrices in blocks, and pose graphs.
#include <algorithm>
#include <array>
#include <cmath>

#include "io/files/text.h"
#include "io/files/written_position.h"
#include "io/scans/pose_text.h"

namespace gaussmap::detail {
namespace {

/// The first block tells how all are written.
struct BlockShape {
  std::size_t before = 0;  // numbers in a line before the matrix: 0, 1 or 3 (.log of Open3D)
  std::size_t rows = 4;    // 3 or 4
};

std::vector<double> numbersIn(const PoseText& text, std::size_t line) {
  return line < text.lines.size() ? numbersOf(fieldsOf(text, text.lines[line].text), 0) : std::vector<double>();
}

bool isLastRow(const std::vector<double>& row) {
  return row.size() == 4 && row[0] == 0.0 && row[1] == 0.0 && row[2] == 0.0;
}

std::optional<BlockShape> shapeOf(const PoseText& text) {
  BlockShape shape;
  const std::size_t words = numbersIn(text, 0).size();
  if (words == 1 || words == 3) shape.before = words;
  const std::size_t first = shape.before > 0 ? 1 : 0;
  for (std::size_t row = 0; row < 3; ++row)
    if (numbersIn(text, first + row).size() != 4) return std::nullopt;
  shape.rows = isLastRow(numbersIn(text, first + 3)) ? 4 : 3;
  return shape;
}

/// Four numbers per line can also be something else, or the columns of matrices.
void requireMatrices(const PoseText& text, const BlockShape& shape) {
  const std::size_t first = shape.before > 0 ? 1 : 0;
  std::vector<double> elements;
  for (std::size_t row = 0; row < 4; ++row) {
    const std::vector<double> values = numbersIn(text, first + row);
    elements.insert(elements.end(), values.begin(), values.end());
  }
  if (shape.rows == 4 || elements.size() < 12) return;
  if (elements.size() == 16 && elements[3] == 0.0 && elements[7] == 0.0 && elements[11] == 0.0 && elements[15] == 1.0)
    text.fail(text.lines[first].number, lastRowFault(elements.data()));
  bool is_matrix = true;  // the elements of a rotation are at most 1
  for (std::size_t i = 0; i < 12; ++i)
    if (i % 4 < 3 && std::abs(elements[i]) > 1.1) is_matrix = false;
  if (shape.before == 0 && !is_matrix)
    text.fail(text.lines[first].number,
              "4 numbers per line: no rotation, nor the rows of matrices; expected for example "
              "'time x y z qx qy qz qw' (TUM)");
}

/// The numbers of the elements that are all 1, or times (BALM writes the time into the last element).
void setBlockTimes(const PoseText& text, const std::vector<Decimal>& corners, PoseFile& file) {
  const TimeUnit unit = unitByMagnitude(largestOf(corners));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    file.entries[i].time = toTime(corners[i], unit);
    if (!file.entries[i].time) text.fail(file.entries[i].line, "the time in the last element is out of range");
  }
}

}  // namespace

bool isBlocks(const PoseText& text) {
  return shapeOf(text).has_value();
}

PoseFile readPoseBlocks(const PoseText& text) {
  const std::optional<BlockShape> shape = shapeOf(text);
  if (!shape)
    text.fail(text.lines.front().number, "not the 16 numbers of a matrix in one line, nor 4 lines of 4 numbers");
  requireMatrices(text, *shape);
  PoseFile file;
  RoundedPositions positions;
  std::vector<Decimal> corners;
  bool all_one = true;
  for (std::size_t line = 0; line < text.lines.size();) {
    const std::size_t number = text.lines[line].number;
    PoseFile::Entry& entry = file.entries.emplace_back();
    entry.line = number;
    if (shape->before > 0) {
      const std::vector<std::string_view> words = fieldsOf(text, text.lines[line++].text);
      const std::optional<Decimal> index = parseDecimal(words.front());
      if (words.size() != shape->before || !index || !index->whole)
        text.fail(number,
                  "expected a line with " + std::to_string(shape->before) + " whole numbers before each matrix");
      entry.index = index->digits;
    }
    std::array<double, 16> elements{};
    std::array<std::string_view, 3> position;
    for (std::size_t row = 0; row < shape->rows; ++row, ++line) {
      const std::vector<double> values = numbersIn(text, line);
      if (values.size() != 4)
        text.fail(line < text.lines.size() ? text.lines[line].number : text.lines.back().number,
                  line < text.lines.size() ? "expected the 4 numbers of row " + std::to_string(row + 1) + " of a matrix"
                                           : "the last matrix is not complete");
      std::copy(values.begin(), values.end(), elements.begin() + static_cast<std::ptrdiff_t>(4 * row));
      if (row < 3) position[row] = fieldsOf(text, text.lines[line].text).back();
      if (const std::string fault = row == 3 ? lastRowFault(elements.data(), true) : ""; !fault.empty())
        text.fail(text.lines[line].number, fault);
      if (row == 3) {
        const std::optional<Decimal> corner = parseDecimal(fieldsOf(text, text.lines[line].text).back());
        all_one = all_one && (!corner || corner->value() == 1.0);
        if (corner) corners.push_back(*corner);
      }
    }
    if (!std::all_of(elements.begin(), elements.begin() + 12, [](double value) { return std::isnan(value); }))
      entry.pose = poseOfMatrix(text, number, elements.data());
    if (entry.pose) positions.add(stepOfRoundedPosition(position), elements[3], elements[7], elements[11]);
  }
  if (!all_one) {
    if (corners.size() != file.entries.size()) text.fail(text.lines.front().number, "not all matrices have a last row");
    setBlockTimes(text, corners, file);
  }
  if (const std::string warning = positions.warning(); !warning.empty())
    file.warnings.push_back(text.path.string() + ": " + warning);
  file.layout = shape->rows == 4 ? "4 x 4 matrices over 4 lines" : "3 x 4 matrices over 3 lines";
  if (!all_one) file.layout += ", the last element is the time";
  if (shape->before > 0) file.layout += ", each behind an index";
  return file;
}

bool isPoseGraph(const PoseText& text) {
  const std::vector<std::string_view> words = splitWords(text.lines.front().text);
  const auto begins = [&](std::string_view start) { return words.front().substr(0, start.size()) == start; };
  return begins("VERTEX") || begins("EDGE") || begins("PARAMS") || words.front() == "FIX";
}

PoseFile readPoseGraph(const PoseText& text) {
  PoseFile file;
  RoundedPositions positions;
  std::string other;
  for (const TextLine& line : text.lines) {
    const std::vector<std::string_view> words = splitWords(line.text);
    const bool is_space = words.front() == "VERTEX_SE3:QUAT";
    if (!is_space && words.front() != "VERTEX_SE2") {
      if (other.empty() && words.front().substr(0, 6) == "VERTEX") other = std::string(words.front());
      continue;
    }
    const std::vector<double> numbers = numbersOf(words, 1);
    const std::optional<Decimal> index = words.size() > 1 ? parseDecimal(words[1]) : std::nullopt;
    const std::size_t expected = is_space ? 8 : 4;
    if (numbers.size() != expected || !index || !index->whole)
      text.fail(line.number, std::string(words.front()) + ": expected " +
                                 (is_space ? "'index x y z qx qy qz qw'" : "'index x y theta'"));
    PoseFile::Entry& entry = file.entries.emplace_back();
    entry.line = line.number;
    entry.index = index->digits;
    if (std::all_of(numbers.begin() + 1, numbers.end(), [](double value) { return std::isnan(value); })) continue;
    Pose pose;
    if (is_space) {
      pose.translation = {numbers[1], numbers[2], numbers[3]};
      pose.rotation = {numbers[7], numbers[4], numbers[5], numbers[6]};
    } else {
      pose.translation = {numbers[1], numbers[2], 0.0};
      pose.rotation = {std::cos(numbers[3] / 2), 0.0, 0.0, std::sin(numbers[3] / 2)};
    }
    if (const std::string fault = poseFault(pose); !fault.empty()) text.fail(line.number, fault);
    entry.pose = normalised(pose);
    positions.add(stepOfRoundedPosition({words[2], words[3], is_space ? words[4] : "0"}), numbers[1], numbers[2],
                  pose.translation.z());
  }
  if (const std::string warning = positions.warning(); !warning.empty())
    file.warnings.push_back(text.path.string() + ": " + warning);
  if (file.entries.empty())
    throw FileError(text.path, "a pose graph without VERTEX_SE3:QUAT or VERTEX_SE2" +
                                   (other.empty() ? std::string() : "; " + quote(other) + " is not supported"));
  file.layout = "vertices of a pose graph";
  file.indices_may_be_ids = true;
  return file;
}

}  // namespace gaussmap::detail
