// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "segments/line_moments.h"

namespace gaussmap::detail {

/// A short section of a segment.
struct SegmentCell {
  LineMoments hits;      ///< moments of the observations in it
  double crossed = 0.0;  ///< rays that passed through it
};

/// A row of cells of equal length along an axis. It stores the evidence of a segment by position along it.
class CellRow {
 public:
  CellRow() = default;
  CellRow(const Vector<2>& origin, const Vector<2>& axis, double size) : origin_(origin), axis_(axis), size_(size) {}

  const Vector<2>& axis() const { return axis_; }
  const Vector<2>& origin() const { return origin_; }
  double size() const { return size_; }
  double position(const Vector<2>& point) const { return axis_.dot(point - origin_); }
  int index(const Vector<2>& point) const { return static_cast<int>(std::floor(position(point) / size_)); }
  int first() const { return first_; }
  int last() const { return first_ + static_cast<int>(cells_.size()); }  ///< index after the last cell
  bool empty() const { return cells_.empty(); }
  const std::vector<SegmentCell>& cells() const { return cells_; }
  std::vector<SegmentCell>& cells() { return cells_; }

  /// Returns the cell with this index. Extends the row if necessary.
  SegmentCell& at(int index);
  void add(const Vector<2>& point, double weight) { at(index(point)).hits.add(point, weight); }
  /// Adds the cells of the other row. Each is added to the cell of this row that contains its mean, or its middle if it
  /// has no hits.
  void absorb(const CellRow& other);
  /// Returns the same evidence along another axis.
  CellRow turned(const Vector<2>& origin, const Vector<2>& axis) const;
  /// Returns the cells [first, last) of cells() as a row, without empty cells at its ends.
  CellRow slice(std::size_t first, std::size_t last) const;
  /// Removes cells without observations from both ends.
  void trim();
  LineMoments total() const;
  std::size_t bytes() const { return cells_.capacity() * sizeof(SegmentCell); }

 private:
  Vector<2> origin_{0.0, 0.0}, axis_{1.0, 0.0};
  double size_ = 1.0;
  int first_ = 0;
  std::vector<SegmentCell> cells_;
};

}  // namespace gaussmap::detail
