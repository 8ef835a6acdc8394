// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/gmap/map_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/floor_divide.h"
#include "core/number_text.h"
#include "core/parallel.h"
#include "io/gmap/assemble_map.h"
#include "io/gmap/map_schema.h"
#include "io/gmap/tile_cache.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kTilesRead = 64;  // number of tiles read before they are decoded in parallel

/// Cells from low to high along every axis, both included.
template <int D>
struct KeyRange {
  CellKey<D> low, high;

  bool contains(const CellKey<D>& key) const {
    for (std::size_t axis = 0; axis < D; ++axis)
      if (key[axis] < low[axis] || key[axis] > high[axis]) return false;
    return true;
  }
  /// Returns the blocks of `span` cells per side that contain these cells.
  KeyRange blocks(std::int64_t span) const {
    KeyRange blocks;
    for (std::size_t axis = 0; axis < D; ++axis) {
      blocks.low[axis] = static_cast<std::int32_t>(floorDivide(low[axis], span));
      blocks.high[axis] = static_cast<std::int32_t>(floorDivide(high[axis], span));
    }
    return blocks;
  }
};

/// Returns the finest cells that intersect a box. The cells of the coarser scales are computed from them in integers,
/// so the parent of a cell in the range is always in the range of the next scale.
template <int D>
KeyRange<D> finestCells(const Box<D>& box, double side) {
  KeyRange<D> range;
  const auto keyOf = [side](double coordinate) {
    constexpr double kMin = std::numeric_limits<std::int32_t>::min(), kMax = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::clamp(std::floor(coordinate / side), kMin, kMax));
  };
  for (int axis = 0; axis < D; ++axis) {
    if (!(box.low(axis) <= box.high(axis)))
      throw std::invalid_argument("the box reaches from " + numberText(box.low(axis)) + " to " +
                                  numberText(box.high(axis)) + " m along axis " + std::to_string(axis) +
                                  ": low must be at most high");
    range.low[static_cast<std::size_t>(axis)] = keyOf(box.low(axis));
    range.high[static_cast<std::size_t>(axis)] = keyOf(box.high(axis));
  }
  return range;
}

template <int D>
using Keys = std::vector<CellKey<D>>;

/// Returns the parents of these cells, sorted and without duplicates.
template <int D>
Keys<D> parentsOf(const Keys<D>& keys, const Grid<D>& grid, int scale) {
  Keys<D> parents;
  for (const CellKey<D>& key : keys) {
    const CellKey<D> parent = grid.ancestor(key, scale, scale + 1);
    if (parents.empty() || parents.back() != parent) parents.push_back(parent);
  }
  std::sort(parents.begin(), parents.end());
  parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
  return parents;
}

}  // namespace

template <int D>
struct MapReader<D>::State {
  /// One version of the file.
  struct Version {
    FileIdentity identity;
    Database database;
    MapMetadata entries;
    Grid<D> grid;
    std::int32_t span;
    TileCache<D> cache;
    MapMetadata metadata;

    Version(const std::filesystem::path& path, const FileIdentity& id, std::size_t cache_bytes)
        : identity(id),
          database(openMap(path)),
          entries(readEntries(database)),
          grid(gridOf(path, entries)),
          span(tileSpan(grid.options())),
          cache(cache_bytes),
          metadata(userEntries(entries)) {}

    static Grid<D> gridOf(const std::filesystem::path& path, const MapMetadata& entries) {
      try {
        return Grid<D>(readOptions<D>(path, entries));
      } catch (const std::invalid_argument& error) {
        throw FileError(path, std::string("is damaged: ") + error.what());
      }
    }
  };

  std::filesystem::path path;
  MapReaderOptions options;
  std::unique_ptr<Version> version;
  mutable std::mutex mutex;
  MapReaderStatistics statistics;

  State(const std::filesystem::path& file, const MapReaderOptions& how) : path(file), options(how) { open(); }

  void open() {
    // The identity is read before the file is opened: if the file is replaced in between, the next
    // refresh() reopens it.
    const FileIdentity identity = identityOf(path);
    version = std::make_unique<Version>(path, identity, options.cache_bytes);
  }

  std::vector<std::shared_ptr<const Tile<D>>> tilesOf(int scale, const KeyRange<D>& range) {
    const KeyRange<D> blocks = range.blocks(version->span);
    const Keys<D> addresses = tilesWithin<D>(version->database, scale, blocks.low, blocks.high);
    std::vector<std::shared_ptr<const Tile<D>>> tiles(addresses.size());
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < addresses.size(); ++i) {
      tiles[i] = version->cache.find(scale, addresses[i]);
      if (!tiles[i]) missing.push_back(i);
    }
    statistics.tiles_cached += addresses.size() - missing.size();
    TileSelect<D> select(version->database);
    for (std::size_t begin = 0; begin < missing.size(); begin += kTilesRead) {
      const std::size_t count = std::min(kTilesRead, missing.size() - begin);
      std::vector<std::string> bytes(count);
      for (std::size_t i = 0; i < count; ++i) bytes[i] = select.read(scale, addresses[missing[begin + i]]);
      parallelFor(count, options.threads, 1, [&](std::size_t i) {
        const TileAddress<D> address{scale, addresses[missing[begin + i]], version->span};
        tiles[missing[begin + i]] =
            std::make_shared<const Tile<D>>(decodeRow<D>(path, bytes[i], address, version->grid.options()));
      });
      for (std::size_t i = begin; i < begin + count; ++i)
        version->cache.insert(scale, addresses[missing[i]], tiles[missing[i]]);
    }
    statistics.tiles_read += missing.size();
    return tiles;
  }

  GaussianMap<D> load(const Box<D>& box, int finest_scale) {
    const Grid<D>& grid = version->grid;
    if (finest_scale < 0 || finest_scale >= grid.scales())
      throw std::out_of_range("scale " + std::to_string(finest_scale) + ": the map has the scales 0 to " +
                              std::to_string(grid.scales() - 1));
    const KeyRange<D> finest = finestCells<D>(box, grid.side(0));
    const auto rangeOf = [&](int scale) { return finest.blocks(grid.cellsAlongSide(scale)); };
    const auto scales = static_cast<std::size_t>(grid.scales());
    std::vector<std::vector<std::shared_ptr<const Tile<D>>>> tiles(scales);
    for (int s = grid.scales() - 1; s >= finest_scale; --s) tiles[static_cast<std::size_t>(s)] = tilesOf(s, rangeOf(s));

    std::vector<Tile<D>> cells(scales);
    Keys<D> wanted, with_children;  // parents of the cells kept, and of all cells read
    for (int s = finest_scale; s < grid.scales(); ++s) {
      const KeyRange<D> range = rangeOf(s);
      Tile<D>& kept = cells[static_cast<std::size_t>(s)];
      const auto isIn = [](const Keys<D>& keys, const CellKey<D>& key) {
        return std::binary_search(keys.begin(), keys.end(), key);
      };
      Keys<D> all;
      for (const auto& tile : tiles[static_cast<std::size_t>(s)]) {
        appendCells<D>(kept, *tile, [&](const CellKey<D>& key) {
          return isIn(wanted, key) || (range.contains(key) && !isIn(with_children, key));
        });
        all.insert(all.end(), tile->keys.begin(), tile->keys.end());
      }
      if (s + 1 == grid.scales()) break;
      wanted = parentsOf<D>(kept.keys, grid, s);
      with_children = parentsOf<D>(all, grid, s);
    }
    try {
      return assembleMap<D>(grid.options(), std::move(cells));
    } catch (const std::invalid_argument& error) {
      throw FileError(path, std::string("is damaged: ") + error.what());
    }
  }
};

template <int D>
MapReader<D>::MapReader(const std::filesystem::path& path, const MapReaderOptions& options)
    : state_(std::make_unique<State>(path, options)) {}
template <int D>
MapReader<D>::~MapReader() = default;
template <int D>
MapReader<D>::MapReader(MapReader&&) noexcept = default;
template <int D>
MapReader<D>& MapReader<D>::operator=(MapReader&&) noexcept = default;

template <int D>
const std::filesystem::path& MapReader<D>::path() const {
  return state_->path;
}
template <int D>
const Grid<D>& MapReader<D>::grid() const {
  return state_->version->grid;
}
template <int D>
const MapMetadata& MapReader<D>::metadata() const {
  return state_->version->metadata;
}
template <int D>
std::size_t MapReader<D>::cellCount(int scale) const {
  return numberIn<std::size_t>(state_->path, state_->version->entries, "cells." + std::to_string(scale));
}
template <int D>
std::size_t MapReader<D>::gaussianCount(int scale) const {
  return numberIn<std::size_t>(state_->path, state_->version->entries, "gaussians." + std::to_string(scale));
}

template <int D>
GaussianMap<D> MapReader<D>::load(const Box<D>& box, int finest_scale) {
  const std::lock_guard lock(state_->mutex);
  return state_->load(box, finest_scale);
}

template <int D>
bool MapReader<D>::refresh() {
  const std::lock_guard lock(state_->mutex);
  if (identityOf(state_->path) == state_->version->identity) return false;
  state_->open();
  return true;
}

template <int D>
MapReaderStatistics MapReader<D>::statistics() const {
  const std::lock_guard lock(state_->mutex);
  MapReaderStatistics statistics = state_->statistics;
  statistics.cache_bytes = state_->version->cache.bytes();
  return statistics;
}

template class MapReader<2>;
template class MapReader<3>;

}  // namespace gaussmap
