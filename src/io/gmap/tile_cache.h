// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <utility>

#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Cache of decoded tiles. If they take more than `max_bytes`, the least recently used tiles are dropped.
template <int D>
class TileCache {
 public:
  using Entry = std::shared_ptr<const Tile<D>>;

  explicit TileCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Returns the tile, or nullptr if it is not in the cache.
  Entry find(int scale, const CellKey<D>& address) {
    const auto found = places_.find({scale, address});
    if (found == places_.end()) return nullptr;
    by_use_.splice(by_use_.begin(), by_use_, found->second);
    return found->second->tile;
  }

  /// Adds a tile that is not in the cache yet. A tile that is larger than the whole cache is not kept.
  void insert(int scale, const CellKey<D>& address, Entry tile) {
    const std::size_t bytes = bytesOf(*tile);
    if (bytes > max_bytes_) return;
    by_use_.push_front({{scale, address}, std::move(tile), bytes});
    places_[{scale, address}] = by_use_.begin();
    bytes_ += bytes;
    while (bytes_ > max_bytes_) {
      bytes_ -= by_use_.back().bytes;
      places_.erase(by_use_.back().address);
      by_use_.pop_back();
    }
  }

  std::size_t bytes() const { return bytes_; }

  static std::size_t bytesOf(const Tile<D>& tile) {
    const auto held = [](const auto& column) { return column.capacity() * sizeof(column[0]); };
    return held(tile.keys) + held(tile.counts) + held(tile.moments) + held(tile.gaussians) + held(tile.labels) +
           held(tile.log_odds);
  }

 private:
  using Address = std::pair<int, CellKey<D>>;
  struct Item {
    Address address;
    Entry tile;
    std::size_t bytes;
  };
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::list<Item> by_use_;  // the most recently used tile comes first
  std::map<Address, typename std::list<Item>::iterator> places_;
};

}  // namespace gaussmap::detail
