// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace gaussmap::detail {

/// A point that a search found.
template <typename Distance, typename Index>
struct Neighbour {
  Distance distance;
  Index index;
  /// The order of results: by distance, then by index.
  friend bool operator<(const Neighbour& a, const Neighbour& b) {
    return a.distance < b.distance || (!(b.distance < a.distance) && a.index < b.index);
  }
};

/// Collects the nearest one of all added neighbours, up to a first limit.
template <typename Distance, typename Index>
class NearestOne {
 public:
  explicit NearestOne(Distance limit) : best_{limit, static_cast<Index>(-1)} {}

  /// Returns the limit: farther neighbours are not collected. It shrinks when a neighbour is collected.
  Distance limit() const { return best_.distance; }
  /// Returns false if the neighbour is not collected.
  bool add(Distance distance, Index index) {
    const Neighbour<Distance, Index> found{distance, index};
    if (!(found < best_)) return false;
    best_ = found;
    return true;
  }
  bool full() const { return best_.index != static_cast<Index>(-1); }
  const Neighbour<Distance, Index>& best() const { return best_; }

 private:
  Neighbour<Distance, Index> best_;
};

/// Collects the `count` >= 1 nearest of all added neighbours, up to a first limit. The limit shrinks once there are
/// `count` neighbours.
template <typename Distance, typename Index>
class NearestList {
 public:
  using Entry = Neighbour<Distance, Index>;

  NearestList(std::size_t count, Distance limit) : count_(count), limit_(limit) {
    entries_.reserve(std::min<std::size_t>(count, kReserve));
  }

  Distance limit() const { return limit_; }
  bool add(Distance distance, Index index) {
    if (!(distance <= limit_)) return false;
    const Entry entry{distance, index};
    const bool is_full = full();
    if (count_ <= kFew) {  // kept sorted
      if (is_full && !(entry < entries_.back())) return false;
      if (!is_full) entries_.push_back(entry);
      std::size_t place = entries_.size() - 1;
      for (; place > 0 && entry < entries_[place - 1]; --place) entries_[place] = entries_[place - 1];
      entries_[place] = entry;
      if (full()) limit_ = entries_.back().distance;
      return true;
    }
    if (is_full) {  // a heap
      if (!(entry < entries_.front())) return false;
      std::pop_heap(entries_.begin(), entries_.end());
      entries_.back() = entry;
    } else {
      entries_.push_back(entry);
    }
    std::push_heap(entries_.begin(), entries_.end());
    if (full()) limit_ = entries_.front().distance;
    return true;
  }
  bool full() const { return entries_.size() == count_; }
  /// Returns all collected neighbours in order. Nothing can be added afterwards.
  const std::vector<Entry>& sort() {
    if (count_ > kFew) std::sort_heap(entries_.begin(), entries_.end());
    return entries_;
  }

 private:
  static constexpr std::size_t kFew = 32;
  static constexpr std::size_t kReserve = 1024;

  std::size_t count_;
  Distance limit_;
  std::vector<Entry> entries_;
};

/// Collects all added neighbours up to a limit.
template <typename Distance, typename Index>
class NeighboursWithin {
 public:
  using Entry = Neighbour<Distance, Index>;

  explicit NeighboursWithin(Distance limit) : limit_(limit) {}

  Distance limit() const { return limit_; }
  bool add(Distance distance, Index index) {
    if (!(distance <= limit_)) return false;
    entries_.push_back({distance, index});
    return true;
  }
  const std::vector<Entry>& sort() {
    std::sort(entries_.begin(), entries_.end());
    return entries_;
  }
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  Distance limit_;
  std::vector<Entry> entries_;
};

}  // namespace gaussmap::detail
