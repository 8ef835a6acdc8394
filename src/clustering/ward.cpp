// SPDX-License-Identifier: BSD-3-Clause
#include "clustering/ward.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "core/function_clones.h"

namespace gaussmap::detail {

namespace {

constexpr std::size_t kMaxGroup = WardMerges::kMaxGroup;
constexpr std::int32_t kSlotBits = static_cast<std::int32_t>(kMaxGroup) - 1;
constexpr float kFar = 1e15f;  // place of the unused slots

/// The clusters of a group, in arrays that fit vector registers. Slots from `size` on are far away.
struct WardSlots {
  alignas(64) float x[kMaxGroup], y[kMaxGroup], z[kMaxGroup], weight[kMaxGroup], height[kMaxGroup];
  std::uint32_t first[kMaxGroup];
  std::size_t size;
};

/// Eight numbers. The compiler turns them into the widest registers of each function clone.
using WardFloats = float __attribute__((vector_size(32)));
using WardInts = std::int32_t __attribute__((vector_size(32)));
constexpr std::size_t kLanes = 8;

__attribute__((always_inline)) inline void loadEight(const float* values, WardFloats& eight) {
  std::memcpy(&eight, values, sizeof eight);
}

/// Returns the cheapest partner of slot `i`: the cost as the bits of a float, of which the lowest six are replaced by
/// the slot. Such integers are ordered like their costs.
__attribute__((always_inline)) inline std::int32_t cheapestPartner(const WardSlots& slots, std::size_t i) {
  const float x = slots.x[i], y = slots.y[i], z = slots.z[i], weight = slots.weight[i];
  const auto self = static_cast<std::int32_t>(i);
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  WardInts slot = {0, 1, 2, 3, 4, 5, 6, 7};
  WardInts least = {kMost, kMost, kMost, kMost, kMost, kMost, kMost, kMost};
  for (std::size_t j = 0; j < slots.size; j += kLanes, slot += static_cast<std::int32_t>(kLanes)) {
    WardFloats dx, dy, dz, other;
    loadEight(slots.x + j, dx);
    loadEight(slots.y + j, dy);
    loadEight(slots.z + j, dz);
    loadEight(slots.weight + j, other);
    dx -= x;
    dy -= y;
    dz -= z;
    const WardFloats cost = weight * other / (weight + other) * (dx * dx + dy * dy + dz * dz);
    WardInts bits;
    std::memcpy(&bits, &cost, sizeof bits);
    const WardInts key = ((bits & ~kSlotBits) | slot) | ((slot == self) & kMost);
    least = key < least ? key : least;
  }
  std::int32_t lanes[kLanes];
  std::memcpy(lanes, &least, sizeof lanes);
  return std::min(std::min(std::min(lanes[0], lanes[4]), std::min(lanes[1], lanes[5])),
                  std::min(std::min(lanes[2], lanes[6]), std::min(lanes[3], lanes[7])));
}

__attribute__((always_inline)) inline float wardCost(const WardSlots& slots, std::size_t i, std::size_t j) {
  const float dx = slots.x[j] - slots.x[i], dy = slots.y[j] - slots.y[i], dz = slots.z[j] - slots.z[i];
  return slots.weight[i] * slots.weight[j] / (slots.weight[i] + slots.weight[j]) * (dx * dx + dy * dy + dz * dz);
}

/// Merges all slots of a group. In each round, all pairs merge that are nearest to each other. A union is never nearer
/// to a third cluster than its nearer part was. So the result is the same as that of always taking the cheapest pair,
/// and a slot needs a new search only if it or its partner was merged. Writes size - 1 merges.
GAUSSMAP_CLONES void mergeGroup(WardSlots& slots, WardMerges::Merge* merges) {
  std::uint8_t partner[kMaxGroup], place[kMaxGroup];
  bool is_merged[kMaxGroup], is_stale[kMaxGroup];
  std::fill_n(is_stale, slots.size, true);
  while (slots.size > 1) {
    const std::size_t size = slots.size;
    for (std::size_t i = 0; i < size; ++i)
      if (is_stale[i]) partner[i] = static_cast<std::uint8_t>(cheapestPartner(slots, i) & kSlotBits);
    std::size_t left = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t j = partner[i];
      is_merged[i] = partner[j] == i;
      if (is_merged[i] && j < i) continue;  // part of slot j by now
      if (is_merged[i]) {
        const float height = std::max({wardCost(slots, i, j), slots.height[i], slots.height[j]});
        *merges++ = {height, slots.first[i], slots.first[j]};
        const float share = slots.weight[j] / (slots.weight[i] + slots.weight[j]);
        slots.x[i] += share * (slots.x[j] - slots.x[i]);
        slots.y[i] += share * (slots.y[j] - slots.y[i]);
        slots.z[i] += share * (slots.z[j] - slots.z[i]);
        slots.weight[i] += slots.weight[j];
        slots.height[i] = height;
      }
      place[i] = static_cast<std::uint8_t>(left);
      slots.x[left] = slots.x[i];
      slots.y[left] = slots.y[i];
      slots.z[left] = slots.z[i];
      slots.weight[left] = slots.weight[i];
      slots.height[left] = slots.height[i];
      slots.first[left++] = slots.first[i];
    }
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t j = partner[i];
      if (is_merged[i] && j < i) continue;
      is_stale[place[i]] = is_merged[j];
      partner[place[i]] = is_merged[j] ? std::uint8_t{0} : place[j];
    }
    for (std::size_t i = left; i < size; ++i) {
      slots.x[i] = slots.y[i] = slots.z[i] = kFar;
      slots.weight[i] = 1.0f;
    }
    slots.size = left;
  }
}

/// Calls group(first, last) for the largest octree nodes with at most kMaxGroup clusters, in their order.
template <typename Group>
void forEachGroup(const std::vector<WardCluster>& clusters, std::size_t first, std::size_t last, int level,
                  const Group& group) {
  if (last - first <= kMaxGroup || level == 0) {
    for (; last - first > kMaxGroup; first += kMaxGroup) group(first, first + kMaxGroup);
    if (first < last) group(first, last);
    return;
  }
  const int shift = 3 * (level - 1);
  for (std::size_t begin = first; begin < last;) {
    const std::uint64_t octant = clusters[begin].code >> shift;
    const auto end =
        std::partition_point(clusters.begin() + std::ptrdiff_t(begin), clusters.begin() + std::ptrdiff_t(last),
                             [&](const WardCluster& c) { return c.code >> shift == octant; });
    const auto after = std::size_t(end - clusters.begin());
    forEachGroup(clusters, begin, after, level - 1, group);
    begin = after;
  }
}

}  // namespace

WardMerges::WardMerges(const std::vector<WardCluster>& clusters, int bits) : size_(clusters.size()) {
  merges_.resize(clusters.size());
  Merge* next = merges_.data();
  WardSlots slots;
  forEachGroup(clusters, 0, clusters.size(), bits, [&](std::size_t first, std::size_t last) {
    slots.size = last - first;
    const std::size_t padded = (slots.size + 7) / 8 * 8;
    for (std::size_t i = 0; i < padded; ++i) {
      const bool is_used = i < slots.size;
      const WardCluster& cluster = clusters[is_used ? first + i : first];
      // Relative to the first cluster, floats keep the precision.
      slots.x[i] = is_used ? static_cast<float>(cluster.x - clusters[first].x) : kFar;
      slots.y[i] = is_used ? static_cast<float>(cluster.y - clusters[first].y) : kFar;
      slots.z[i] = is_used ? static_cast<float>(cluster.z - clusters[first].z) : kFar;
      slots.weight[i] = is_used ? static_cast<float>(cluster.weight) : 1.0f;
      slots.height[i] = 0.0f;
      slots.first[i] = static_cast<std::uint32_t>(first + i);
    }
    mergeGroup(slots, next);
    next += last - first - 1;
  });
  merges_.resize(std::size_t(next - merges_.data()));
}

std::vector<std::uint32_t> WardMerges::cut(std::size_t count) const {
  const std::size_t wanted = size_ > count ? std::min(size_ - count, merges_.size()) : 0;
  // The costs are not negative, so their bits are in their order. Of equal costs, the merge made first is first.
  std::uint64_t limit = 0;
  const auto keyOf = [&](std::size_t i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &merges_[i].cost, sizeof bits);
    return std::uint64_t{bits} << 32 | i;
  };
  if (wanted == merges_.size()) {
    limit = std::numeric_limits<std::uint64_t>::max();
  } else {
    std::vector<std::uint64_t> keys(merges_.size());
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = keyOf(i);
    std::nth_element(keys.begin(), keys.begin() + std::ptrdiff_t(wanted), keys.end());
    limit = keys[wanted];
  }
  std::vector<std::uint32_t> unions(size_);
  for (std::size_t i = 0; i < size_; ++i) unions[i] = static_cast<std::uint32_t>(i);
  for (std::size_t i = 0; i < merges_.size(); ++i)
    if (keyOf(i) < limit) unions[merges_[i].second] = merges_[i].first;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < size_; ++i) unions[i] = unions[i] == i ? next++ : unions[unions[i]];
  return unions;
}

}  // namespace gaussmap::detail
