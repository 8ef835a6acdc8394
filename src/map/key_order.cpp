// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "common/floor_divide.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {
namespace {

/// Codes of up to 103 bits: per axis at most 2^32 coordinates and as many again for the rounding to whole ancestors.
__extension__ typedef unsigned __int128 LongCode;

struct Extent {
  std::int64_t lowest = 0;
  std::uint64_t count = 1;  // of ancestors at the coarsest scale along this axis
};

/// One number a cell whose order is key order: the coarsest ancestor counted x, y, z, then at each finer scale the
/// place among its parent's children, counted the same way.
template <int D, typename Code>
std::vector<Code> orderCodes(const std::vector<CellKey<D>>& keys, const std::array<Extent, D>& extents,
                             std::uint64_t ratio, int levels, std::uint64_t span) {
  std::vector<Code> codes(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::array<std::uint64_t, D> rest;  // coordinate within the coarsest ancestor
    Code code = 0;
    for (std::size_t axis = 0; axis < D; ++axis) {
      const auto from_lowest =
          static_cast<std::uint64_t>(keys[i][axis] - extents[axis].lowest * static_cast<std::int64_t>(span));
      code = code * extents[axis].count + from_lowest / span;
      rest[axis] = from_lowest % span;
    }
    std::uint64_t child_span = span;
    for (int level = 0; level < levels; ++level) {
      child_span /= ratio;
      for (std::size_t axis = 0; axis < D; ++axis) {
        code = code * ratio + rest[axis] / child_span;
        rest[axis] %= child_span;
      }
    }
    codes[i] = code;
  }
  return codes;
}

/// Least-significant-digit radix sort of (code, index), 11 bits a pass.
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
  const auto unsigned_ratio = static_cast<std::uint64_t>(ratio);
  const auto unsigned_span = static_cast<std::uint64_t>(span);
  if (bits < 63.0)
    return sortedByRadix(orderCodes<D, std::uint64_t>(keys, extents, unsigned_ratio, levels, unsigned_span),
                         static_cast<int>(bits) + 1);
  const std::vector<LongCode> codes = orderCodes<D, LongCode>(keys, extents, unsigned_ratio, levels, unsigned_span);
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  return order;
}

template std::vector<std::uint32_t> keyOrder<2>(const std::vector<CellKey<2>>&, int, int);
template std::vector<std::uint32_t> keyOrder<3>(const std::vector<CellKey<3>>&, int, int);

}  // namespace gaussmap
