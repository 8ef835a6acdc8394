// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace gaussmap::detail {

/// Hash table from the key of a cell to its index. The keys are stored only in the cells. It uses open addressing with
/// 8 bytes per slot, and is at most half full. An erased entry leaves no tombstone, so the table does not become
/// slower over time.
class KeyIndex {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  KeyIndex() : slots_(64) {}

  std::size_t size() const { return size_; }
  std::size_t memoryBytes() const { return slots_.capacity() * sizeof(Slot); }

  template <std::size_t N>
  static std::uint32_t hashOf(const std::array<std::int32_t, N>& key) {
    std::uint64_t hash = 0;
    for (const std::int32_t k : key) {
      hash = (hash ^ static_cast<std::uint32_t>(k)) * 0x9E3779B97F4A7C15ull;
      hash ^= hash >> 32;
    }
    return static_cast<std::uint32_t>(hash);
  }

  /// Returns the index with this hash for which isKey(index) is true, or kNone.
  template <typename IsKey>
  std::uint32_t find(std::uint32_t hash, const IsKey& isKey) const {
    for (std::size_t i = hash & mask();; i = (i + 1) & mask()) {
      const Slot& slot = slots_[i];
      if (slot.index == kNone) return kNone;
      if (slot.hash == hash && isKey(slot.index)) return slot.index;
    }
  }

  /// Adds an entry. The key must not be in the table yet.
  void insert(std::uint32_t hash, std::uint32_t index) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    enter({hash, index});
    ++size_;
  }

  /// Removes an entry, which must be in the table.
  void erase(std::uint32_t hash, std::uint32_t index) {
    std::size_t hole = hash & mask();
    while (slots_[hole].index != index) hole = (hole + 1) & mask();
    // Entries that the erased entry had displaced move back.
    for (std::size_t i = (hole + 1) & mask(); slots_[i].index != kNone; i = (i + 1) & mask()) {
      const std::size_t home = slots_[i].hash & mask();
      if (((i - home) & mask()) < ((i - hole) & mask())) continue;
      slots_[hole] = slots_[i];
      hole = i;
    }
    slots_[hole] = Slot();
    --size_;
  }

 private:
  struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t index = kNone;
  };
  std::size_t mask() const { return slots_.size() - 1; }
  void enter(const Slot& slot) {
    std::size_t i = slot.hash & mask();
    while (slots_[i].index != kNone) i = (i + 1) & mask();
    slots_[i] = slot;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.index != kNone) enter(slot);
  }

  std::vector<Slot> slots_;  // the size is a power of two
  std::size_t size_ = 0;
};

}  // namespace gaussmap::detail
