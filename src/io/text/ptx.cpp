// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/ptx.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/pose.h"
#include "io/files/text.h"
#include "io/text/row_index.h"
#include "io/text/text_layout.h"
#include "io/text/text_rows.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kLongestHeaderLine = 1000;

struct PtxScan {
  Pose pose;
  std::size_t points_per_column = 0;  // of the scanner; the points of a column follow each other in the file
  std::size_t columns = 0;            // numbers per row of the file
};

struct OpenPtx {
  std::filesystem::path path;
  std::shared_ptr<const MappedFile> file;
  std::vector<PtxScan> scans;
  RowIndex index;
  std::vector<std::string> warnings;

  const char* end() const { return file->bytes().data() + file->bytes().size(); }
};

/// Returns the values of the points: intensity and colour, as far as the rows have them.
std::vector<PointValue> ptxValues(std::size_t columns) {
  std::vector<PointValue> values;
  if (columns == 4 || columns == 7) values.push_back({"intensity", ValueKind::Plain, {3}});
  if (columns > 4) values.push_back({"rgb", ValueKind::Channels, {columns - 3, columns - 2, columns - 1}});
  return values;
}

class PtxParser {
 public:
  explicit PtxParser(OpenPtx& ptx)
      : ptx_(ptx), rows_(ptx.path, ptx.end(), ' ', 0), place_{ptx.file->bytes().data(), 1} {
    if (ptx.file->bytes().substr(0, kByteOrderMark.size()) == kByteOrderMark) place_.at += kByteOrderMark.size();
  }

  void parse() {
    while (rows_.findRow(place_)) parseScan();
  }

 private:
  std::string scanName() const { return "scan " + std::to_string(ptx_.scans.size()); }

  /// Reads a line of the header with exactly `count` numbers.
  void numbers(const std::string& what, std::size_t count, double* values) {
    const auto fail = [&](const std::string& found) {
      rows_.fail(place_.line, found + " instead of " + std::to_string(count) + (count == 1 ? " number" : " numbers") +
                                  ": " + what + " of " + scanName());
    };
    if (!rows_.findRow(place_)) fail("the file ends");
    std::string_view rest(place_.at, static_cast<std::size_t>(ptx_.end() - place_.at));
    const std::string_view line = takeLine(rest);
    if (line.size() > kLongestHeaderLine) fail("a line of more than 1000 characters");
    const std::vector<std::string_view> words = splitWords(line);
    if (words.size() != count) fail(std::to_string(words.size()) + (words.size() == 1 ? " word" : " words"));
    for (std::size_t i = 0; i < count; ++i)
      if (!parseNumber(words[i], values[i])) fail(quote(words[i]));
    line_ = place_.line;
    rows_.skipLine(place_);
  }

  std::size_t wholeNumber(const std::string& what) {
    double value = 0.0;
    numbers(what, 1, &value);
    if (!(value >= 0.0 && value <= std::numeric_limits<int>::max()) || value != std::floor(value))
      rows_.fail(line_, what + " of " + scanName() + " must be a whole number from 0 to 2147483647");
    return static_cast<std::size_t>(value);
  }

  void parseScan() {
    PtxScan scan;
    const std::size_t first_line = place_.line;
    const std::size_t scanner_columns = wholeNumber("the number of columns");
    scan.points_per_column = wholeNumber("the number of rows");
    Eigen::Matrix<double, 4, 3, Eigen::RowMajor> position_and_axes;
    for (Eigen::Index i = 0; i < 4; ++i)
      numbers(i == 0 ? "the position of the scanner" : "an axis of the scanner", 3, position_and_axes.row(i).data());
    Eigen::Matrix4d matrix;
    for (Eigen::Index i = 0; i < 4; ++i) {
      Eigen::RowVector4d row;
      numbers("a row of the matrix", 4, row.data());
      matrix.row(i) = row;
    }
    scan.pose = poseOf(matrix);
    warnOfOtherAxes(position_and_axes, matrix);
    addPoints(first_line, scanner_columns, scan);
    if (ptx_.scans.size() == kMostScans)
      throw FileError(ptx_.path, "more than " + std::to_string(kMostScans) + " scans: is this a PTX file?");
    ptx_.scans.push_back(scan);
  }

  /// The matrix acts on rows: p_map = p_scanner M. So the last row is the translation.
  Pose poseOf(const Eigen::Matrix4d& matrix) const {
    constexpr double kTolerance = kQuaternionTolerance;
    const auto fail = [&](const std::string& what) {
      rows_.fail(line_, "the matrix of " + scanName() + " (lines " + std::to_string(line_ - 3) + " to " +
                            std::to_string(line_) + ") " + what);
    };
    if (!matrix.allFinite()) fail("is not finite");
    const Eigen::Vector4d last(0.0, 0.0, 0.0, 1.0);
    if (!matrix.col(3).isApprox(last, 1e-9)) {
      if (matrix.row(3).transpose().isApprox(last, 1e-9))
        fail("is transposed: the translation must be in its last row, not in its last column");
      fail("does not end in a column 0 0 0 1");
    }
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>().transpose();
    if (!((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kTolerance))
      fail("is not a rigid motion: it scales or shears; export the scan without a scale");
    if (rotation.determinant() < 0.0) fail("is not a rigid motion: it mirrors");
    Pose pose;
    pose.translation = matrix.row(3).head<3>().transpose();
    pose.rotation = Pose::Rotation(rotation);
    if (const std::string fault = poseFault(pose); !fault.empty()) fail("is not a pose: " + fault);
    return normalised(pose);
  }

  /// The position and the axes repeat the matrix. Some programs leave them at zero and identity.
  void warnOfOtherAxes(const Eigen::Matrix<double, 4, 3, Eigen::RowMajor>& axes, const Eigen::Matrix4d& matrix) {
    if (!ptx_.warnings.empty()) return;
    const auto differ = [](const auto& a, const auto& b) {
      return !((a - b).cwiseAbs().maxCoeff() <= 1e-3 * (1.0 + b.cwiseAbs().maxCoeff()));
    };
    const bool other_position = !axes.row(0).isZero(0.0) && differ(axes.row(0), matrix.row(3).head<3>());
    const bool other_axes = !axes.bottomRows<3>().isIdentity(0.0) && !axes.bottomRows<3>().isZero(0.0) &&
                            differ(axes.bottomRows<3>(), matrix.topLeftCorner<3, 3>());
    if (other_position || other_axes)
      ptx_.warnings.push_back(scanName() + ": the " + (other_position ? "position" : "axes") +
                              " of the scanner before the matrix and the matrix differ; the matrix is used");
  }

  void addPoints(std::size_t first_line, std::size_t scanner_columns, PtxScan& scan) {
    const std::size_t points = scanner_columns * scan.points_per_column;  // two numbers of 31 bits
    const auto left = static_cast<std::size_t>(ptx_.end() - place_.at);
    const std::string count = std::to_string(scanner_columns) + " x " + std::to_string(scan.points_per_column) +
                              " points of line " + std::to_string(first_line);
    // The shortest row is "1 2 3" with a line end.
    if (points > left / 6 + 1)
      rows_.fail(place_.line, "the " + count + " do not fit in the " + std::to_string(left) + " bytes that follow");
    scan.columns = 4;
    if (points > 0 && rows_.findRow(place_)) {
      std::string_view rest(place_.at, static_cast<std::size_t>(ptx_.end() - place_.at));
      scan.columns = splitWords(takeLine(rest).substr(0, kLongestHeaderLine)).size();
      if (scan.columns != 3 && scan.columns != 4 && scan.columns != 6 && scan.columns != 7)
        rows_.fail(place_.line, std::to_string(scan.columns) +
                                    " columns instead of x y z, x y z intensity, or x y z intensity r g b");
    }
    const std::size_t found = addRows(rows_, place_, points, ptx_.index);
    if (found < points) rows_.fail(place_.line, "the file ends after " + std::to_string(found) + " of the " + count);
  }

  OpenPtx& ptx_;
  RowParser rows_;
  TextPlace place_;
  std::size_t line_ = 0;  // of the last header line
};

class PtxReader : public ScanReader {
 public:
  PtxReader(std::shared_ptr<const OpenPtx> ptx, std::size_t scan)
      : ptx_(std::move(ptx)), scan_(ptx_->scans[scan]), block_(ptx_->index.blocks[scan]) {}

  std::size_t size() const override { return block_.rows; }
  int columns() const override { return static_cast<int>(scan_.points_per_column); }

  void read(std::size_t first, PointBlock<3>& block) const override {
    block.size = first < size() ? std::min(size() - first, PointBlock<3>::kCapacity) : 0;
    readColumns(first, block.size, {{0, block.coordinate[0]}, {1, block.coordinate[1]}, {2, block.coordinate[2]}});
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < block.size; ++i)
      if (block.coordinate[0][i] == 0.0 && block.coordinate[1][i] == 0.0 && block.coordinate[2][i] == 0.0)
        for (double* const axis : block.coordinate) axis[i] = kNaN;  // no return
  }
  void requireWhole() const override { ptx_->file->requireWhole(); }

  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const PointValue& value : ptxValues(scan_.columns)) names.push_back(value.name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const PointValue& value : ptxValues(scan_.columns)) {
      if (value.name != name) continue;
      std::vector<std::vector<double>> columns(value.columns.size(), std::vector<double>(size()));
      std::vector<WantedColumn> wanted;
      for (std::size_t i = 0; i < columns.size(); ++i) wanted.push_back({value.columns[i], columns[i].data()});
      readColumns(0, size(), wanted);
      return makeValue(ptx_->path, value, std::move(columns));
    }
    return ScanReader::values(name);
  }

 private:
  void readColumns(std::size_t first, std::size_t count, const std::vector<WantedColumn>& wanted) const {
    readRows(RowParser(ptx_->path, ptx_->end(), ' ', scan_.columns), ptx_->index, block_, first, count, wanted);
  }

  std::shared_ptr<const OpenPtx> ptx_;
  PtxScan scan_;
  RowBlock block_;
};

class PtxFile : public ScanFile {
 public:
  explicit PtxFile(std::shared_ptr<const OpenPtx> ptx) : ptx_(std::move(ptx)) {}

  std::string kind() const override { return "PTX text"; }
  std::size_t size() const override { return ptx_->scans.size(); }
  FileScanInfo info(std::size_t scan) const override {
    const std::string name = size() > 1 ? "scan " + std::to_string(scan) : "";
    return {name, ptx_->index.blocks[scan].rows, ptx_->scans[scan].pose};
  }
  std::unique_ptr<ScanReader> open(std::size_t scan) const override { return std::make_unique<PtxReader>(ptx_, scan); }
  std::string poseSource() const override { return "PTX header of each scan"; }
  std::size_t memoryOf(std::size_t) const override { return 0; }
  void releasePages() const override { ptx_->file->release(); }
  std::vector<std::string> warnings() const override { return ptx_->warnings; }

 private:
  std::shared_ptr<const OpenPtx> ptx_;
};

}  // namespace

bool isPtx(std::string_view text) {
  constexpr std::size_t kNumbers[] = {1, 1, 3};
  for (const std::size_t count : kNumbers) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos || end > kLongestHeaderLine) return false;
    const std::vector<std::string_view> words = splitWords(text.substr(0, end));
    double ignored = 0.0;
    if (words.size() != count) return false;
    for (const std::string_view word : words)
      if (!parseNumber(word, ignored)) return false;
    text.remove_prefix(end + 1);
  }
  return true;
}

std::unique_ptr<ScanFile> openPtx(const std::filesystem::path& path, std::shared_ptr<const MappedFile> file) {
  auto ptx = std::make_shared<OpenPtx>();
  ptx->path = path;
  ptx->file = std::move(file);
  PtxParser(*ptx).parse();
  return std::make_unique<PtxFile>(std::move(ptx));
}

}  // namespace gaussmap::detail
