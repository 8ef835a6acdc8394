// SPDX-License-Identifier: BSD-3-Clause
#include "segments/cell_row.h"

namespace gaussmap::detail {

SegmentCell& CellRow::at(int index) {
  if (cells_.empty()) {
    first_ = index;
    cells_.resize(1);
  } else if (index < first_) {
    cells_.insert(cells_.begin(), static_cast<std::size_t>(std::int64_t{first_} - index), SegmentCell());
    first_ = index;
  } else if (index >= last()) {
    cells_.resize(static_cast<std::size_t>(std::int64_t{index} - first_ + 1));
  }
  return cells_[static_cast<std::size_t>(index - first_)];
}

void CellRow::absorb(const CellRow& other) {
  for (std::size_t i = 0; i < other.cells_.size(); ++i) {
    const SegmentCell& cell = other.cells_[i];
    if (cell.hits.n > 0.0) {
      SegmentCell& own = at(index(cell.hits.mean()));
      own.hits += cell.hits;
      own.crossed += cell.crossed;
    } else if (cell.crossed > 0.0) {
      const double middle = (static_cast<double>(other.first_) + static_cast<double>(i) + 0.5) * other.size_;
      at(index(other.origin_ + middle * other.axis_)).crossed += cell.crossed;
    }
  }
}

CellRow CellRow::turned(const Vector<2>& origin, const Vector<2>& axis) const {
  CellRow row(origin, axis, size_);
  row.absorb(*this);
  return row;
}

CellRow CellRow::slice(std::size_t first, std::size_t last) const {
  CellRow row(origin_, axis_, size_);
  row.first_ = first_ + static_cast<int>(first);
  row.cells_.assign(cells_.begin() + static_cast<std::ptrdiff_t>(first),
                    cells_.begin() + static_cast<std::ptrdiff_t>(last));
  row.trim();
  return row;
}

void CellRow::trim() {
  std::size_t begin = 0, end = cells_.size();
  while (begin < end && cells_[begin].hits.n <= 0.0) ++begin;
  while (end > begin && cells_[end - 1].hits.n <= 0.0) --end;
  if (begin == 0 && end == cells_.size()) return;
  cells_.erase(cells_.begin() + static_cast<std::ptrdiff_t>(end), cells_.end());
  cells_.erase(cells_.begin(), cells_.begin() + static_cast<std::ptrdiff_t>(begin));
  first_ += static_cast<int>(begin);
}

LineMoments CellRow::total() const {
  LineMoments sum;
  for (const SegmentCell& cell : cells_) sum += cell.hits;
  return sum;
}

}  // namespace gaussmap::detail
