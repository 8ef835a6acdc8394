// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/sorted_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/morton.h"
#include "core/number_text.h"
#include "map/lattice.h"

namespace gaussmap::detail {

namespace {

bool hasThreeNumbers(const float* p) {
  const float zero = (p[0] - p[0]) + (p[1] - p[1]) + (p[2] - p[2]);
  return zero == 0.0f;  // NaN and infinity minus themselves are NaN
}

int bitsFor(std::uint64_t value) {
  int bits = 0;
  for (; value > 0; value >>= 1) ++bits;
  return bits;
}

/// Gathers every third bit: the inverse of spreadBits().
std::uint64_t gatherBits(std::uint64_t bits) {
  bits &= 0x1249249249249249ull;
  bits = (bits | bits >> 2) & 0x10C30C30C30C30C3ull;
  bits = (bits | bits >> 4) & 0x100F00F00F00F00Full;
  bits = (bits | bits >> 8) & 0x1F0000FF0000FFull;
  bits = (bits | bits >> 16) & 0x1F00000000FFFFull;
  return (bits | bits >> 32) & 0x1FFFFF;
}

using Words = std::vector<std::uint64_t, PagesAllocator<std::uint64_t>>;

/// Sorts by the bits from `low` on, kDigitBits per pass. Uses `spare` as memory.
template <int kDigitBits>
void sortByDigits(Words& items, Words& spare, int low, int bits) {
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  std::array<std::uint32_t, kDigits> place;
  spare.resize(items.size());
  for (int shift = low; shift < low + bits; shift += kDigitBits) {
    place.fill(0);
    for (const std::uint64_t item : items) ++place[item >> shift & (kDigits - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& entry : place) {
      const std::uint32_t here = entry;
      entry = sum;
      sum += here;
    }
    for (const std::uint64_t item : items) spare[place[item >> shift & (kDigits - 1)]++] = item;
    items.swap(spare);
  }
}

}  // namespace

SortedPoints::SortedPoints(const PointsView& points, double side, int bits) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  std::size_t finite = 0;
  for (std::size_t i = 0; i < points.count; ++i) {
    const float* const p = points[i];
    if (!hasThreeNumbers(p)) continue;
    ++finite;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  if (finite == 0) return;
  double farthest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    extent_ = std::max(extent_, double(high[axis]) - double(low[axis]));
    farthest = std::max({farthest, std::abs(double(low[axis])), std::abs(double(high[axis]))});
  }
  side_ = side;
  if (!(side > 0.0)) {
    side_ = std::max(extent_ / double((std::int64_t{1} << (bits - 1)) - 2), farthest * 0x1p-23);
    if (!(side_ > std::numeric_limits<float>::min())) side_ = 1.0;  // all points are at the origin
  }
  const double per_metre = 1.0 / side_;
  const auto cellOf = [&](float p) { return std::floor(double(p) * per_metre); };
  std::uint64_t most = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::abs(double(low[axis])) * per_metre > 2e9 || std::abs(double(high[axis])) * per_metre > 2e9) {
      const double corner[3] = {double(high[0]), double(high[1]), double(high[2])};
      throwOutsideLattice(corner, 3, side_);
    }
    most = std::max(most, std::uint64_t(cellOf(high[axis]) - cellOf(low[axis])));
  }
  bits_ = bitsFor(most) + 1;
  if (bits_ > kMaxBits)
    throw std::out_of_range("cells of " + numberText(side_) + " m are too small for a cloud of " + numberText(extent_) +
                            " m: use larger cells");
  const std::int64_t whole = ~((std::int64_t{1} << (bits_ - 1)) - 1);
  std::array<double, 3> base;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    base_[axis] = std::int64_t(cellOf(low[axis])) & whole;
    base[axis] = double(base_[axis]);
  }
  const int index_bits = bitsFor(points.count);
  const auto codeOf = [&](const float* p) {
    const auto cell = [&](std::size_t axis) { return std::uint64_t(double(p[axis]) * per_metre - base[axis]); };
    return mortonCode(cell(0), cell(1), cell(2));
  };
  if (3 * bits_ + index_bits <= 64) {
    Words items(finite);
    std::size_t next = 0;
    for (std::size_t i = 0; i < points.count; ++i)
      if (hasThreeNumbers(points[i])) items[next++] = codeOf(points[i]) << index_bits | i;
    sortPacked(items, index_bits);
  } else {
    MortonItems items(finite), spare;
    std::size_t next = 0;
    for (std::size_t i = 0; i < points.count; ++i)
      if (hasThreeNumbers(points[i])) items[next++] = {codeOf(points[i]), std::uint32_t(i)};
    sortByCode(items.data(), items.size(), spare);
    codes_.resize(finite);
    indices_.resize(finite);
    for (std::size_t i = 0; i < finite; ++i) {
      codes_[i] = items[i].code;
      indices_[i] = items[i].index;
    }
  }
  countCells();
}

void SortedPoints::sortPacked(Words& items, int index_bits) {
  constexpr std::size_t kFewItems = 3000;
  Words spare;
  if (items.size() < kFewItems)
    sortByDigits<8>(items, spare, index_bits, 3 * bits_);
  else
    sortByDigits<12>(items, spare, index_bits, 3 * bits_);
  codes_.resize(items.size());
  indices_.resize(items.size());
  const std::uint64_t mask = (std::uint64_t{1} << index_bits) - 1;
  for (std::size_t i = 0; i < items.size(); ++i) {
    codes_[i] = items[i] >> index_bits;
    indices_[i] = std::uint32_t(items[i] & mask);
  }
}

void SortedPoints::countCells() {
  std::array<std::size_t, 65> highest{};  // how often a bit is the highest in which neighbours differ, counted from 1
  for (std::size_t i = 1; i < codes_.size(); ++i) {
    const std::uint64_t differ = codes_[i] ^ codes_[i - 1];
    ++highest[differ == 0 ? 0u : std::size_t(64 - __builtin_clzll(differ))];
  }
  std::size_t count = 1;
  for (std::size_t level = kMaxBits + 1; level-- > 0;) {
    for (std::size_t bit = 3 * level + 1; bit <= 3 * level + 3; ++bit) count += highest[bit];
    counts_[level] = count;
  }
}

CellKey<3> SortedPoints::keyOf(std::uint64_t code, int level) const {
  CellKey<3> key;
  for (std::size_t axis = 0; axis < 3; ++axis)
    key[axis] = std::int32_t((base_[axis] >> level) + std::int64_t(gatherBits(code >> axis)));
  return key;
}

SortedCells cellsOf(const SortedPoints& sorted, const PointsView& points, int level) {
  SortedCells cells;
  const std::size_t count = sorted.size() > 0 ? sorted.cellCount(level) : 0;
  cells.side = sorted.side(level);
  cells.keys.reserve(count);
  cells.codes.reserve(count);
  cells.moments.reserve(count);
  cells.first_point.reserve(count + 1);
  const double steps_per_metre = stepsPerMetre(cells.side);
  for (std::size_t i = 0; i < sorted.size();) {
    const std::uint64_t code = sorted.code(i) >> 3 * level;
    const CellKey<3> key = sorted.keyOf(code, level);
    double centre[3];
    for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = (double(key[axis]) + 0.5) * double(kStepsPerCell);
    CellMoments<3> moments;
    cells.first_point.push_back(std::uint32_t(i));
    for (; i < sorted.size() && sorted.code(i) >> 3 * level == code; ++i) {
      const float* const p = points[sorted.index(i)];
      CellMoments<3>::Offset offset;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto steps = std::int32_t(snap(double(p[axis]) * steps_per_metre - centre[axis]));
        offset[axis] = std::clamp(steps, -32768, 32767);
      }
      moments.add(offset);
    }
    cells.keys.push_back(key);
    cells.codes.push_back(code);
    cells.moments.push_back(moments);
  }
  cells.first_point.push_back(std::uint32_t(sorted.size()));
  return cells;
}

}  // namespace gaussmap::detail
