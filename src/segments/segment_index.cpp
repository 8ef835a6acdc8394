// SPDX-License-Identifier: BSD-3-Clause
#include "segments/segment_index.h"

#include <algorithm>
#include <cmath>

namespace gaussmap::detail {
namespace {

constexpr double kSlack = 0.15;  // strips are entered with this margin, so that small changes cost nothing [m]

}  // namespace

bool Strip::contains(const Vector<2>& point) const {
  const Vector<2> from = point - start;
  const double along = direction.dot(from), across = direction.x() * from.y() - direction.y() * from.x();
  return std::abs(across) <= half_width && along >= 0.0 && along <= length;
}

Strip Strip::grown(double by) const {
  return {start - by * direction, direction, length + 2.0 * by, half_width + by};
}

void SegmentIndex::update(int id, const Strip& strip) {
  if (static_cast<std::size_t>(id) >= entered_.size()) entered_.resize(static_cast<std::size_t>(id) + 1);
  Entered& entered = entered_[static_cast<std::size_t>(id)];
  const Vector<2> across(-strip.direction.y() * strip.half_width, strip.direction.x() * strip.half_width),
      end = strip.start + strip.length * strip.direction;
  if (entered.in_use && entered.strip.length < strip.length + 4.0 * kSlack &&
      entered.strip.contains(strip.start + across) && entered.strip.contains(strip.start - across) &&
      entered.strip.contains(end + across) && entered.strip.contains(end - across))
    return;
  erase(id);
  entered.in_use = true;
  entered.strip = strip.grown(kSlack);
  // Finds the rows that the strip passes through, for each column of the lattice.
  const Strip& wide = entered.strip;
  Vector<2> a = wide.start, b = wide.start + wide.length * wide.direction;
  const bool steep = std::abs(wide.direction.y()) > std::abs(wide.direction.x());
  if (steep) std::swap(a.x(), a.y()), std::swap(b.x(), b.y());
  if (a.x() > b.x()) std::swap(a, b);
  const double main = std::max(std::abs(wide.direction.x()), std::abs(wide.direction.y()));
  const double reach = wide.half_width / main, over = wide.half_width * std::sqrt(1.0 - main * main);
  const double slope = b.x() > a.x() ? (b.y() - a.y()) / (b.x() - a.x()) : 0.0;
  const std::int64_t first = lattice(a.x() - over), last = lattice(b.x() + over);
  for (std::int64_t column = first; column <= last; ++column) {
    const double left = std::max(static_cast<double>(column) * cell_, a.x() - over) - a.x(),
                 right = std::min(static_cast<double>(column + 1) * cell_, b.x() + over) - a.x();
    const double low = a.y() + std::min(slope * left, slope * right) - reach,
                 high = a.y() + std::max(slope * left, slope * right) + reach;
    for (std::int64_t row = lattice(low); row <= lattice(high); ++row) {
      const std::uint64_t cell = steep ? key(row, column) : key(column, row);
      entered.keys.push_back(cell);
      cells_[cell].push_back(id);
    }
  }
}

void SegmentIndex::erase(int id) {
  if (static_cast<std::size_t>(id) >= entered_.size()) return;
  Entered& entered = entered_[static_cast<std::size_t>(id)];
  for (const std::uint64_t key : entered.keys) {
    const auto cell = cells_.find(key);
    std::vector<int>& ids = cell->second;
    ids.erase(std::find(ids.begin(), ids.end(), id));
    if (ids.empty()) cells_.erase(cell);
  }
  entered.keys.clear();
  entered.in_use = false;
}

const std::vector<int>& SegmentIndex::near(const Vector<2>& point) const {
  const auto cell = cells_.find(key(lattice(point.x()), lattice(point.y())));
  return cell == cells_.end() ? none_ : cell->second;
}

std::size_t SegmentIndex::bytes() const {
  std::size_t sum = entered_.capacity() * sizeof(Entered) + cells_.bucket_count() * sizeof(void*);
  for (const Entered& entered : entered_) sum += entered.keys.capacity() * sizeof(std::uint64_t);
  for (const auto& cell : cells_) sum += 48 + cell.second.capacity() * sizeof(int);
  return sum;
}

std::uint64_t SegmentIndex::key(std::int64_t column, std::int64_t row) const {
  return (static_cast<std::uint64_t>(column) << 32) ^ (static_cast<std::uint64_t>(row) & 0xFFFFFFFFu);
}

std::int64_t SegmentIndex::lattice(double coordinate) const {
  return static_cast<std::int64_t>(std::floor(coordinate / cell_));
}

}  // namespace gaussmap::detail
