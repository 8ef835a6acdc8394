// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/gmap/map_file.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/gmap/assemble_map.h"
#include "io/gmap/map_schema.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Reads the cells of all tiles of one scale.
template <int D>
Tile<D> readTiles(const Database& database, int s, const MapOptions& options) {
  Tile<D> all;
  Statement select(database,
                   "SELECT x, y, z, data FROM tiles WHERE scale = " + std::to_string(s) + " ORDER BY x, y, z");
  std::optional<CellKey<D>> last;
  while (select.step()) {
    TileAddress<D> address{s, {}, tileSpan(options)};
    for (std::size_t axis = 0; axis < D; ++axis) {
      const std::int64_t coordinate = select.integer(static_cast<int>(axis));
      address.tile[axis] = static_cast<std::int32_t>(coordinate);
      if (address.tile[axis] != coordinate) throw std::invalid_argument("a tile lies beyond all cells");
    }
    if (last && !(*last < address.tile)) throw std::invalid_argument("tiles are out of order or occur twice");
    last = address.tile;
    appendTile<D>(all, decodeRow<D>(database.path(), select.blob(3), address, options));
  }
  return all;
}

}  // namespace

template <int D>
GaussianMap<D> load(const std::filesystem::path& path) {
  const Database database = openMap(path);
  const MapMetadata entries = readEntries(database);
  const MapOptions options = readOptions<D>(path, entries);
  try {
    const Grid<D> grid(options);
    std::vector<Tile<D>> scales(static_cast<std::size_t>(grid.scales()));
    for (int s = grid.scales() - 1; s >= 0; --s) {
      Tile<D>& cells = scales[static_cast<std::size_t>(s)];
      cells = readTiles<D>(database, s, options);
      const auto stated = numberIn<std::size_t>(path, entries, "cells." + std::to_string(s));
      if (cells.keys.size() != stated)
        throw std::invalid_argument("scale " + std::to_string(s) + " has " + std::to_string(cells.keys.size()) +
                                    " cells, but " + std::to_string(stated) + " were saved");
    }
    return assembleMap<D>(options, std::move(scales));
  } catch (const std::invalid_argument& error) {
    throw FileError(path, std::string("is damaged: ") + error.what());
  }
}

int mapDimensions(const std::filesystem::path& path) {
  const int dimensions = numberIn<int>(path, readEntries(openMap(path)), "dimension");
  if (dimensions != 2 && dimensions != 3)
    throw FileError(path, "holds a map of dimension " + std::to_string(dimensions) + ", expected 2 or 3");
  return dimensions;
}

MapMetadata loadMetadata(const std::filesystem::path& path) {
  return userEntries(readEntries(openMap(path)));
}

MapFileSize mapFileSize(const std::filesystem::path& path) {
  const Database database = openMap(path);
  MapFileSize size{std::filesystem::file_size(path), {}};
  Statement select(database, "SELECT scale, SUM(LENGTH(data)) FROM tiles WHERE scale BETWEEN 0 AND 63 GROUP BY scale");
  while (select.step()) {
    size.scale_tiles.resize(std::max(size.scale_tiles.size(), static_cast<std::size_t>(select.integer(0)) + 1), 0);
    size.scale_tiles[static_cast<std::size_t>(select.integer(0))] = static_cast<std::uintmax_t>(select.integer(1));
  }
  return size;
}

template GaussianMap<2> load<2>(const std::filesystem::path&);
template GaussianMap<3> load(const std::filesystem::path&);

}  // namespace gaussmap
