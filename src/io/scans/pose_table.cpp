// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/files/text.h"
#include "io/files/written_position.h"
#include "io/scans/pose_text.h"

namespace gaussmap::detail {
namespace {

constexpr std::uint64_t kMaxKeyIndex = 100000000;  // larger whole numbers are times
constexpr std::array<PoseColumn, 3> kPositionColumns = {PoseColumn::X, PoseColumn::Y, PoseColumn::Z};

/// Returns the index that a number is, also if it is written as 7.000000; nullopt if it is not whole or too large.
std::optional<std::uint64_t> indexOf(const Decimal& number) {
  std::uint64_t index = number.digits;
  for (int i = 0; i < number.exponent && index > 0 && index < kMaxKeyIndex; ++i) index *= 10;
  for (int i = number.exponent; i < 0 && index > 0; ++i) {
    if (index % 10 != 0) return std::nullopt;
    index /= 10;
  }
  if (index >= kMaxKeyIndex || (number.negative && index > 0)) return std::nullopt;
  return index;
}

/// Reads the lines of a table one by one.
class TableReader {
 public:
  TableReader(const PoseText& text, const PoseLayout& layout) : text_(text), layout_(layout) {
    const auto text_columns = {PoseColumn::Name, PoseColumn::Key};
    // A blank in a name can be told from a separator only if the name comes first.
    join_name_ = !layout.columns.empty() &&
                 std::find(text_columns.begin(), text_columns.end(), layout.columns.front()) != text_columns.end();
  }

  PoseFile read(std::size_t first) {
    PoseFile file;
    for (std::size_t i = first; i < text_.lines.size(); ++i) file.entries.push_back(parse(text_.lines[i]));
    setTimes(file);
    if (const std::string warning = positions_.warning(); !warning.empty())
      file.warnings.push_back(text_.path.string() + ": " + warning);
    return file;
  }

 private:
  PoseFile::Entry parse(const TextLine& line) {
    const std::vector<std::string_view> fields = fieldsOf(text_, line.text, join_name_);
    if (fields.size() < layout_.columns.size() || (width_ != 0 && fields.size() != width_))
      text_.fail(line.number, "the line has another layout than the lines before it: " + std::to_string(fields.size()) +
                                  " values instead of " +
                                  std::to_string(width_ != 0 ? width_ : layout_.columns.size()));
    width_ = fields.size();
    numbers_.fill(std::numeric_limits<double>::quiet_NaN());
    PoseFile::Entry entry;
    entry.line = line.number;
    keys_.emplace_back();
    nanoseconds_.emplace_back();
    int pose_numbers = 0, nan_numbers = 0;
    for (std::size_t i = 0; i < layout_.columns.size(); ++i) {
      const PoseColumn column = layout_.columns[i];
      if (column < PoseColumn::X) {
        setKey(column, fields[i], entry);
        continue;
      }
      double& value = numbers_[static_cast<std::size_t>(column)];
      if (!parseNumber(fields[i], value))
        text_.fail(line.number, quote(fields[i]) + " in column " + std::to_string(i + 1) +
                                    " is not a number, unlike in the lines before it (another layout?)");
      ++pose_numbers;
      if (std::isnan(value)) ++nan_numbers;
    }
    if (layout_.last_row && nan_numbers < pose_numbers) requireLastRow(line.number, fields);
    if (nan_numbers < pose_numbers) entry.pose = pose(line.number);
    if (entry.pose) addPosition(fields, *entry.pose);
    return entry;
  }

  void requireLastRow(std::size_t line, const std::vector<std::string_view>& fields) const {
    std::array<double, 16> elements{};
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (const std::string_view field = fields[*layout_.last_row - 12 + i]; !parseNumber(field, elements[i]))
        text_.fail(line, quote(field) + " is not a number");
    if (const std::string fault = lastRowFault(elements.data()); !fault.empty()) text_.fail(line, fault);
  }

  void addPosition(const std::vector<std::string_view>& fields, const Pose& pose) {
    std::array<std::string_view, 3> words;
    for (std::size_t i = 0; i < layout_.columns.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (layout_.columns[i] == kPositionColumns[axis] ||
            layout_.columns[i] == matrixColumn(4 * static_cast<int>(axis) + 3))
          words[axis] = fields[i];
    const Eigen::Vector3d& t = pose.translation;
    positions_.add(stepOfRoundedPosition(words), t.x(), t.y(), t.z());
  }

  void setKey(PoseColumn column, std::string_view field, PoseFile::Entry& entry) {
    if (column == PoseColumn::Skip) return;
    const std::optional<Decimal> number = parseDecimal(field);
    if (column == PoseColumn::Name || column == PoseColumn::Key || column == PoseColumn::Time)
      entry.name = std::string(field);
    if (column == PoseColumn::Name) return;
    if (!number) {
      if (column != PoseColumn::Key && column != PoseColumn::Index)
        text_.fail(entry.line, quote(field) + " is not a time");
      if (column == PoseColumn::Index && layout_.has(PoseColumn::Time)) return;  // a "frame_id" such as "odom"
      entry.name = std::string(field);
      named_ = true;
      return;
    }
    if (column == PoseColumn::Index && number->whole) entry.index = number->digits;
    if (column == PoseColumn::Key || column == PoseColumn::Time || column == PoseColumn::Seconds)
      keys_.back() = *number;
    if (column == PoseColumn::Nanoseconds) nanoseconds_.back() = *number;
  }

  Pose pose(std::size_t line) const {
    const auto at = [&](PoseColumn column) { return numbers_[static_cast<std::size_t>(column)]; };
    if (layout_.rotation == RotationKind::Matrix)
      return poseOfMatrix(text_, line, &numbers_[static_cast<std::size_t>(PoseColumn::M11)]);
    Pose pose;
    pose.translation = {at(PoseColumn::X), at(PoseColumn::Y), at(PoseColumn::Z)};
    if (layout_.rotation == RotationKind::Quaternion) {
      pose.rotation = {at(PoseColumn::QW), at(PoseColumn::QX), at(PoseColumn::QY), at(PoseColumn::QZ)};
    } else {
      const double unit = layout_.degrees ? std::acos(-1.0) / 180.0 : 1.0;
      const Eigen::AngleAxisd yaw(at(PoseColumn::Yaw) * unit, Eigen::Vector3d::UnitZ()),
          pitch(at(PoseColumn::Pitch) * unit, Eigen::Vector3d::UnitY()),
          roll(at(PoseColumn::Roll) * unit, Eigen::Vector3d::UnitX());
      pose.rotation = Eigen::Quaterniond(yaw * pitch * roll);
    }
    if (const std::string fault = poseFault(pose); !fault.empty()) text_.fail(line, fault);
    return normalised(pose);
  }

  /// The keys of all lines together decide what they are.
  void setTimes(PoseFile& file) const {
    const bool has_key = layout_.has(PoseColumn::Key);
    file.by_name = layout_.has(PoseColumn::Name) || named_;
    const bool has_time = layout_.has(PoseColumn::Time) || layout_.has(PoseColumn::Seconds);
    if ((!has_key && !has_time) || (has_key && named_)) return;
    const bool has_index = layout_.has(PoseColumn::Index);
    if (!has_index && std::all_of(keys_.begin(), keys_.end(),
                                  [](const std::optional<Decimal>& key) { return key && indexOf(*key).has_value(); })) {
      for (std::size_t i = 0; i < keys_.size(); ++i) file.entries[i].index = indexOf(*keys_[i]);
      const bool has_digits_only =
          std::all_of(keys_.begin(), keys_.end(), [](const std::optional<Decimal>& key) { return key->whole; });
      if (has_key && has_digits_only) return;
      // A header calls them times, or they are written as 7.000000, but they can be the numbers of scans.
      file.indices_may_be_ids = true;
    }
    double largest = 0.0;
    for (const std::optional<Decimal>& key : keys_)
      if (key) largest = std::max(largest, std::abs(key->value()));
    const TimeUnit unit = layout_.unit.value_or(unitByMagnitude(largest));
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      const std::size_t line = file.entries[i].line;
      if (!keys_[i]) text_.fail(line, "no time, unlike the other lines");
      std::optional<Instant> time = toTime(*keys_[i], unit);
      if (time && nanoseconds_[i]) {
        const std::optional<Instant> rest = toTime(*nanoseconds_[i], TimeUnit::Nanoseconds);
        time = rest ? std::optional(*time + *rest) : std::nullopt;
      }
      if (!time) text_.fail(line, "the time is out of range");
      file.entries[i].time = time;
    }
  }

  const PoseText& text_;
  const PoseLayout& layout_;
  bool join_name_ = false;
  bool named_ = false;  // a key is not a number
  std::size_t width_ = 0;
  std::array<double, static_cast<std::size_t>(PoseColumn::MEnd)> numbers_{};
  std::vector<std::optional<Decimal>> keys_, nanoseconds_;
  RoundedPositions positions_;
};

}  // namespace

PoseFile readPoseTable(const PoseText& text, const PoseLayout& layout, std::size_t first) {
  if (first >= text.lines.size()) throw FileError(text.path, "no pose in this file, only a header line");
  return TableReader(text, layout).read(first);
}

}  // namespace gaussmap::detail
