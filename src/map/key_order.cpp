// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "core/floor_divide.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Codes of up to 103 bits. Per axis there are at most 2^32 coordinates, and as many again for the rounding to whole
/// ancestors.
__extension__ typedef unsigned __int128 LongCode;

struct Extent {
  std::int64_t lowest = 0;
  std::uint64_t count = 1;  // number of ancestors at the coarsest scale along this axis
};

struct Levels {
  std::uint64_t ratio = 2;
  int count = 0;           // number of coarser scales
  std::uint64_t span = 1;  // cells along the side of a cell of the coarsest scale
};

/// Returns what one coordinate adds to the code of a cell. The coordinate is counted from the lowest ancestor on its
/// axis.
template <int D, typename Code>
Code axisCode(std::size_t axis, std::uint64_t coordinate, const std::array<Extent, D>& extents, const Levels& levels) {
  Code code = 0;
  for (std::size_t a = 0; a < D; ++a) code = code * extents[a].count + (a == axis ? coordinate / levels.span : 0);
  std::uint64_t rest = coordinate % levels.span, span = levels.span;
  for (int level = 0; level < levels.count; ++level) {
    span /= levels.ratio;
    for (std::size_t a = 0; a < D; ++a) code = code * levels.ratio + (a == axis ? rest / span : 0);
    rest %= span;
  }
  return code;
}

/// Returns one code per cell. The order of the codes is the key order. A code starts with the position of the coarsest
/// ancestor, counted by x, then y, then z. For each finer scale it continues with the position among the children of
/// the parent, counted in the same way. The contribution of an axis comes from a table if the table is shorter than the
/// list of cells; this saves the divisions.
template <int D, typename Code>
std::vector<Code> orderCodes(const std::vector<CellKey<D>>& keys, const std::array<Extent, D>& extents,
                             const Levels& levels) {
  std::vector<Code> codes(keys.size()), table;
  for (std::size_t axis = 0; axis < D; ++axis) {
    const std::int64_t lowest = extents[axis].lowest * static_cast<std::int64_t>(levels.span);
    const auto coordinate = [&](std::size_t i) { return static_cast<std::uint64_t>(keys[i][axis] - lowest); };
    const std::uint64_t length = extents[axis].count * levels.span;
    if (length > keys.size()) {
      for (std::size_t i = 0; i < keys.size(); ++i) codes[i] += axisCode<D, Code>(axis, coordinate(i), extents, levels);
      continue;
    }
    table.resize(length);
    for (std::uint64_t k = 0; k < length; ++k) table[k] = axisCode<D, Code>(axis, k, extents, levels);
    for (std::size_t i = 0; i < keys.size(); ++i) codes[i] += table[coordinate(i)];
  }
  return codes;
}

/// Sorts (code, index) with a least-significant-digit radix sort, 11 bits per pass. Returns the indices.
std::vector<std::uint32_t> sortedByRadix(const std::vector<std::uint64_t>& codes, int bits) {
  struct Item {
    std::uint64_t code;
    std::uint32_t index;
  };
  constexpr int kDigitBits = 11;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  std::vector<Item> items(codes.size()), sorted(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) items[i] = {codes[i], static_cast<std::uint32_t>(i)};
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    std::array<std::size_t, kDigits> place{};
    for (const Item& item : items) ++place[(item.code >> shift) & (kDigits - 1)];
    std::size_t before = 0;
    for (std::size_t& count : place) before += std::exchange(count, before);
    for (const Item& item : items) sorted[place[(item.code >> shift) & (kDigits - 1)]++] = item;
    items.swap(sorted);
  }
  std::vector<std::uint32_t> order(codes.size());
  for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].index;
  return order;
}

}  // namespace

template <int D>
std::vector<std::uint32_t> keyOrder(const std::vector<CellKey<D>>& keys, int ratio, int levels) {
  std::int64_t span = 1;
  for (int level = 0; level < levels; ++level) span *= ratio;
  std::array<Extent, D> extents;
  double bits = 0.0;
  for (std::size_t axis = 0; axis < D && !keys.empty(); ++axis) {
    const auto [low, high] = std::minmax_element(
        keys.begin(), keys.end(), [axis](const CellKey<D>& a, const CellKey<D>& b) { return a[axis] < b[axis]; });
    extents[axis].lowest = floorDivide((*low)[axis], span);
    extents[axis].count = static_cast<std::uint64_t>(floorDivide((*high)[axis], span) - extents[axis].lowest + 1);
    bits += std::log2(static_cast<double>(extents[axis].count)) + std::log2(static_cast<double>(span));
  }
  const Levels above{static_cast<std::uint64_t>(ratio), levels, static_cast<std::uint64_t>(span)};
  if (bits < 63.0) return sortedByRadix(orderCodes<D, std::uint64_t>(keys, extents, above), static_cast<int>(bits) + 1);
  const std::vector<LongCode> codes = orderCodes<D, LongCode>(keys, extents, above);
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  return order;
}

template std::vector<std::uint32_t> keyOrder<2>(const std::vector<CellKey<2>>&, int, int);
template std::vector<std::uint32_t> keyOrder<3>(const std::vector<CellKey<3>>&, int, int);

}  // namespace gaussmap
