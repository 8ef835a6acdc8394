// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/pose_text.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

constexpr double kRotationTolerance = 1e-3;

using MatrixRows = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>;

double rotationError(const MatrixRows& matrix) {
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  return (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

bool isNumber(std::string_view word) {
  double value = 0.0;
  return parseNumber(word, value);
}

bool endsWithNumbers(std::string_view line, int count) {
  for (int i = 0; i < count; ++i) {
    const std::size_t last = line.find_last_not_of(" \t,;");
    if (last == std::string_view::npos) return false;
    line = line.substr(0, last + 1);
    const std::size_t before = line.find_last_of(" \t,;");
    if (!isNumber(before == std::string_view::npos ? line : line.substr(before + 1))) return false;
    line = before == std::string_view::npos ? std::string_view() : line.substr(0, before);
  }
  return true;
}

/// Removes a comment behind the numbers of a line: "... 0 0 1 # scan". A name in front of them can contain # too.
std::string_view withoutComment(std::string_view line) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    const bool is_mark = line[i] == '#' || line[i] == '%' || line.substr(i, 2) == "//";
    if (is_mark && isBlank(line[i - 1]) && endsWithNumbers(line.substr(0, i), 3)) return trimmed(line.substr(0, i));
  }
  return line;
}

bool isUtf16(std::string_view text) {
  const auto isZero = [&](std::size_t i) { return i < text.size() && text[i] == '\0'; };
  const std::string_view mark = text.substr(0, 2);
  return mark == "\xFF\xFE" || mark == "\xFE\xFF" || (isZero(1) && isZero(3)) || (isZero(0) && isZero(2));
}

/// Returns true for "1,5" and "-1,5e-3".
bool hasDecimalComma(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == 0 || comma == std::string_view::npos || comma + 1 == word.size()) return false;
  std::string number(word);
  number[comma] = '.';
  return number[comma - 1] >= '0' && number[comma - 1] <= '9' && number[comma + 1] >= '0' && number[comma + 1] <= '9' &&
         isNumber(number);
}

/// Calls text.fail() if the numbers of a line have decimal commas.
void requireNoDecimalCommas(const PoseText& text, const TextLine& line) {
  std::vector<std::string_view> words;
  if (text.separator == ';') {
    words = fieldsOf(text, line.text);
  } else if (text.separator == ',') {
    words = splitWords(line.text);
  }
  std::size_t commas = 0, numbers = 0;
  std::string_view first;
  for (const std::string_view word : words) {
    if (hasDecimalComma(word) && commas++ == 0) first = word;
    if (hasDecimalComma(word) || isNumber(word)) ++numbers;
  }
  if (commas < 3 || numbers + 1 < words.size()) return;  // one word can be a name
  std::string right(first);
  right[right.find(',')] = '.';
  text.fail(line.number, "decimal comma: write " + right + ", not " + std::string(first));
}

}  // namespace

void PoseText::fail(std::size_t line, const std::string& what) const {
  throw FileError(path, "line " + std::to_string(line) + ": " + what);
}

PoseText splitPoseText(const std::filesystem::path& path, std::string_view rest) {
  PoseText text;
  text.path = path;
  if (isUtf16(rest)) throw FileError(path, "the file is UTF-16: save it as UTF-8");
  if (rest.substr(0, kByteOrderMark.size()) == kByteOrderMark) rest.remove_prefix(kByteOrderMark.size());
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::string_view line = trimmed(takeLine(rest));
    if (line.empty()) continue;
    if (line.front() != '#' && line.front() != '%')
      text.lines.push_back({number, withoutComment(line)});
    else if (text.lines.empty())
      text.comments.push_back({number, line});
  }
  if (text.lines.empty()) throw FileError(path, "no pose in this file");
  const std::string_view last = text.lines.back().text;
  if (last.find(';') != std::string_view::npos)
    text.separator = ';';
  else if (last.find(',') != std::string_view::npos)
    text.separator = ',';
  requireNoDecimalCommas(text, text.lines.back());
  return text;
}

std::vector<std::string_view> fieldsOf(const PoseText& text, std::string_view line, bool join_name) {
  std::vector<std::string_view> fields;
  if (text.separator == ' ') {
    fields = splitWords(line);
    if (!join_name) return fields;
    std::size_t name_words = fields.size();
    while (name_words > 0 && isNumber(fields[name_words - 1])) --name_words;
    if (name_words < 2) return fields;
    const std::string_view first = fields.front(), last = fields[name_words - 1];
    fields.erase(fields.begin() + 1, fields.begin() + static_cast<std::ptrdiff_t>(name_words));
    fields.front() = std::string_view(first.data(), static_cast<std::size_t>(last.data() + last.size() - first.data()));
    return fields;
  }
  while (true) {
    const std::size_t end = line.find(text.separator);
    const std::string_view field = trimmed(line.substr(0, end));
    // Blanks within a field separate numbers too, but not the words of a name.
    const std::vector<std::string_view> words = splitWords(field);
    if (words.size() > 1 && std::all_of(words.begin(), words.end(), isNumber))
      fields.insert(fields.end(), words.begin(), words.end());
    else
      fields.push_back(field);
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  if (fields.size() > 1 && fields.back().empty()) fields.pop_back();  // a separator at the end of the line
  return fields;
}

std::vector<double> numbersOf(const std::vector<std::string_view>& fields, std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < fields.size(); ++i) {
    double value = 0.0;
    if (!parseNumber(fields[i], value)) return {};
    numbers.push_back(value);
  }
  return numbers;
}

bool isRigid(const double* elements) {
  const MatrixRows matrix(elements);
  return matrix.allFinite() && rotationError(matrix) <= kRotationTolerance && matrix.leftCols<3>().determinant() > 0.0;
}

std::string lastRowFault(const double* elements, bool any_corner) {
  const double* const row = elements + 12;
  if (row[0] == 0.0 && row[1] == 0.0 && row[2] == 0.0 && (any_corner || row[3] == 1.0)) return "";
  if (std::all_of(elements, elements + 12, [](double value) { return std::isnan(value); }) && std::isnan(row[0]))
    return "";
  std::ostringstream text;
  text << "the last row of the 4 x 4 matrix is " << row[0] << ' ' << row[1] << ' ' << row[2] << ' ' << row[3]
       << " instead of 0 0 0 1";
  const bool by_columns = elements[3] == 0.0 && elements[7] == 0.0 && elements[11] == 0.0 && row[3] == 1.0;
  if (by_columns) text << "; is it written column by column?";
  return text.str();
}

Pose poseOfMatrix(const PoseText& text, std::size_t line, const double* elements) {
  const MatrixRows matrix(elements);
  if (!matrix.allFinite()) text.fail(line, "the matrix is not finite");
  const double error = rotationError(matrix);
  if (!(error <= kRotationTolerance)) {
    std::ostringstream what;
    what << "the 3 x 3 part is not a rotation: R R' differs from the identity by " << error;
    text.fail(line, what.str());
  }
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  if (rotation.determinant() < 0.0) text.fail(line, "the 3 x 3 part is a reflection (determinant -1), not a rotation");
  Pose pose;
  pose.translation = matrix.col(3);
  pose.rotation = rotation;
  return normalised(pose);
}

}  // namespace gaussmap::detail
