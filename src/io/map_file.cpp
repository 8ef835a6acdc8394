// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/map_file.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

#include "common/floor_divide.h"
#include "common/parallel.h"
#include "gaussmap/io/atomic_file.h"
#include "gaussmap/io/error.h"
#include "io/sqlite.h"
#include "io/tile_codec.h"
#include "map/link_cells.h"

namespace gaussmap {
namespace {

constexpr std::int32_t kLeastSpan = 32;
constexpr std::size_t kTilesAtOnce = 256;  // compressed together: bounds the memory of a save
constexpr const char* kPrefix = "user.";   // of the caller's metadata, so that names cannot collide

/// Cells along the side of a tile: a power of the ratio, so that a tile is a block of whole parents.
std::int32_t tileSpan(const MapOptions& options) {
  std::int64_t span = options.ratio;
  while (span < kLeastSpan) span *= options.ratio;
  return static_cast<std::int32_t>(span);
}

/// Shortest text that reads back as the same double, in any locale.
std::string exactText(double value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

template <int D>
std::map<CellKey<D>, std::vector<IndexRange>> tilesOf(const MapScale<D>& scale, std::int32_t span) {
  std::map<CellKey<D>, std::vector<IndexRange>> tiles;
  for (std::size_t cell = 0; cell < scale.keys.size(); ++cell) {
    CellKey<D> tile;
    for (std::size_t axis = 0; axis < D; ++axis)
      tile[axis] = static_cast<std::int32_t>(floorDivide(scale.keys[cell][axis], span));
    std::vector<IndexRange>& runs = tiles[tile];
    if (!runs.empty() && runs.back().last == cell)
      ++runs.back().last;
    else
      runs.push_back({cell, cell + 1});
  }
  return tiles;
}

template <int D>
Tile<D> cutTile(const GaussianMap<D>& map, int s, const std::vector<IndexRange>& runs) {
  const MapScale<D>& scale = map.scale(s);
  Tile<D> tile;
  for (const IndexRange& run : runs)
    for (std::size_t cell = run.first; cell < run.last; ++cell) {
      const IndexRange range = map.gaussiansOf(cell, s);
      tile.keys.push_back(scale.keys[cell]);
      tile.counts.push_back(static_cast<std::uint32_t>(range.size()));
      if (!scale.moments.empty()) tile.moments.push_back(scale.moments[cell]);
      for (std::size_t i = range.first; i < range.last; ++i) {
        if (scale.moments.empty()) tile.gaussians.push_back(scale.gaussians[i]);
        if (map.hasOccupancy()) tile.log_odds.push_back(scale.log_odds[i]);
        if (s + 1 == map.scales()) continue;
        const std::size_t parent = scale.parent[i];
        const std::size_t first = map.gaussiansOf(map.cellOf(parent, s + 1), s + 1).first;
        tile.labels.push_back(static_cast<std::uint32_t>(parent - first));
      }
    }
  return tile;
}

template <int D>
void writeTiles(const GaussianMap<D>& map, int s, const SaveOptions& options, Statement& insert) {
  const std::int32_t span = tileSpan(map.options());
  const auto tiles = tilesOf<D>(map.scale(s), span);
  struct Row {
    CellKey<D> tile;
    const std::vector<IndexRange>* runs;
    std::size_t cells, gaussians;
    std::string bytes;
  };
  std::vector<Row> rows;
  for (auto next = tiles.begin(); next != tiles.end();) {
    rows.clear();
    for (; next != tiles.end() && rows.size() < kTilesAtOnce; ++next)
      rows.push_back({next->first, &next->second, 0, 0, {}});
    parallelFor(rows.size(), options.threads, 1, [&](std::size_t i) {
      const Tile<D> tile = cutTile<D>(map, s, *rows[i].runs);
      rows[i].cells = tile.keys.size();
      rows[i].gaussians = tile.moments.empty() ? tile.gaussians.size() : tile.keys.size();
      rows[i].bytes = encodeTile<D>(tile, {s, rows[i].tile, span}, map.options(), options.compression);
    });
    for (const Row& row : rows) {
      insert.bind(1, std::int64_t{s});
      for (std::size_t axis = 0; axis < 3; ++axis)
        insert.bind(2 + static_cast<int>(axis), axis < D ? std::int64_t{row.tile[axis]} : std::int64_t{0});
      insert.bind(5, static_cast<std::int64_t>(row.cells));
      insert.bind(6, static_cast<std::int64_t>(row.gaussians));
      insert.bindBlob(7, row.bytes);
      insert.step();
      insert.reset();
    }
  }
}

/// Opens a map file and checks whose it is.
Database openMap(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw FileError(path, "does not exist");
  if (!std::filesystem::is_regular_file(path, error)) throw FileError(path, "is not a file");
  const std::string start = "SQLite format 3";
  std::string head(start.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(path, "cannot be opened for reading");
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (file.gcount() == 0) throw FileError(path, "is empty");
  if (head != start) throw FileError(path, "is no map: it does not begin like a .gmap");
  Database database(path, Database::Mode::ReadOnly);
  Statement id(database, "PRAGMA application_id");
  if (!id.step() || id.integer(0) != kMapFileId) throw FileError(path, "is an SQLite database, but not a gaussmap map");
  Statement version(database, "PRAGMA user_version");
  if (!version.step() || version.integer(0) != kMapFileVersion)
    throw FileError(path, "has schema version " + std::to_string(version.integer(0)) + ", this program reads version " +
                              std::to_string(kMapFileVersion) + ": use the gaussmap that wrote it");
  return database;
}

MapMetadata readMetadata(const Database& database) {
  MapMetadata metadata;
  Statement select(database, "SELECT name, value FROM metadata");
  while (select.step()) metadata[select.text(0)] = select.text(1);
  return metadata;
}

class MetadataReader {
 public:
  MetadataReader(const std::filesystem::path& path, const MapMetadata& metadata) : path_(path), metadata_(metadata) {}
  template <typename Number>
  Number number(const std::string& name) const {
    const auto entry = metadata_.find(name);
    if (entry == metadata_.end()) throw FileError(path_, "its metadata lack '" + name + "'");
    Number value{};
    const char* end = entry->second.data() + entry->second.size();
    const auto [stop, error] = std::from_chars(entry->second.data(), end, value);
    if (error != std::errc() || stop != end)
      throw FileError(path_, "its metadata give '" + entry->second + "' for '" + name + "'");
    return value;
  }

 private:
  const std::filesystem::path& path_;
  const MapMetadata& metadata_;
};

/// Tiles of one scale, one after the other.
template <int D>
Tile<D> readTiles(const Database& database, int s, const MapOptions& options) {
  Tile<D> all;
  Statement select(database,
                   "SELECT x, y, z, data FROM tiles WHERE scale = " + std::to_string(s) + " ORDER BY x, y, z");
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  std::optional<CellKey<D>> last;
  while (select.step()) {
    TileAddress<D> address{s, {}, tileSpan(options)};
    for (std::size_t axis = 0; axis < D; ++axis) {
      const std::int64_t coordinate = select.integer(static_cast<int>(axis));
      address.tile[axis] = static_cast<std::int32_t>(coordinate);
      if (address.tile[axis] != coordinate) throw std::invalid_argument("a tile that lies beyond all cells");
    }
    if (last && !(*last < address.tile)) throw std::invalid_argument("tiles out of order or there twice");
    last = address.tile;
    try {
      const Tile<D> tile = decodeTile<D>(select.blob(3), address, options);
      append(all.keys, tile.keys);
      append(all.counts, tile.counts);
      append(all.moments, tile.moments);
      append(all.gaussians, tile.gaussians);
      append(all.labels, tile.labels);
      append(all.log_odds, tile.log_odds);
    } catch (const std::runtime_error& error) {
      throw FileError(database.path(), "tile " + toString<D>(address.tile) + " of scale " + std::to_string(s) +
                                           " is damaged: " + error.what());
    }
  }
  return all;
}

template <int D>
struct OrderedScale {
  MapScale<D> scale;
  std::vector<std::uint32_t> labels;
};

/// Puts the cells of a scale into key order.
template <int D>
OrderedScale<D> inKeyOrder(const Tile<D>& tile, const MapOptions& options, int s) {
  std::vector<std::size_t> first(tile.keys.size() + 1, 0);
  for (std::size_t i = 0; i < tile.counts.size(); ++i) first[i + 1] = first[i] + tile.counts[i];
  const bool single = first.back() == tile.keys.size();
  if (!tile.moments.empty() && (tile.moments.size() != tile.keys.size() || !tile.gaussians.empty()))
    throw std::invalid_argument("some cells hold moments and some do not");
  if (!tile.log_odds.empty() && tile.log_odds.size() != first.back())
    throw std::invalid_argument("some cells hold an occupancy and some do not");
  OrderedScale<D> ordered;
  MapScale<D>& scale = ordered.scale;
  if (!single) scale.first_gaussian.push_back(0);
  for (const std::uint32_t from : keyOrder<D>(tile.keys, options.ratio, options.scales - 1 - s)) {
    scale.keys.push_back(tile.keys[from]);
    if (!tile.moments.empty()) scale.moments.push_back(tile.moments[from]);
    for (std::size_t i = first[from]; i < first[from + 1]; ++i) {
      if (!tile.gaussians.empty()) scale.gaussians.push_back(tile.gaussians[i]);
      if (!tile.log_odds.empty()) scale.log_odds.push_back(tile.log_odds[i]);
      if (s + 1 == options.scales) continue;
      if (i >= tile.labels.size()) throw std::invalid_argument("a Gaussian without a parent");
      ordered.labels.push_back(tile.labels[i]);
    }
    if (!single) scale.first_gaussian.push_back(static_cast<std::uint32_t>(scale.gaussians.size()));
  }
  return ordered;
}

/// Finds the children of every cell and turns labels into parents.
template <int D>
void link(MapScale<D>& finer, const std::vector<std::uint32_t>& labels, MapScale<D>& coarse, const Grid<D>& grid,
          int s) {
  coarse.first_child = linkCells<D>(finer.keys, coarse.keys, grid, s);
  const auto startOf = [](const std::vector<std::uint32_t>& first_gaussian, std::size_t cell) {
    return first_gaussian.empty() ? cell : std::size_t{first_gaussian[cell]};
  };
  finer.parent.reserve(labels.size());
  for (std::size_t cell = 0; cell < coarse.keys.size(); ++cell) {
    const std::size_t first = startOf(coarse.first_gaussian, cell);
    const std::size_t last = startOf(finer.first_gaussian, coarse.first_child[cell + 1]);
    while (finer.parent.size() < last)
      finer.parent.push_back(static_cast<std::uint32_t>(first + labels[finer.parent.size()]));
  }
}

template <int D>
void writeMap(Database& database, const GaussianMap<D>& map, const MapMetadata& metadata, const SaveOptions& options) {
  database.execute("PRAGMA application_id = " + std::to_string(kMapFileId) +
                   "; PRAGMA user_version = " + std::to_string(kMapFileVersion) +
                   "; BEGIN;"
                   "CREATE TABLE metadata (name TEXT PRIMARY KEY, value TEXT NOT NULL);"
                   "CREATE TABLE tiles (scale INTEGER NOT NULL, x INTEGER NOT NULL, y INTEGER NOT NULL,"
                   " z INTEGER NOT NULL, cells INTEGER NOT NULL, gaussians INTEGER NOT NULL, data BLOB NOT NULL,"
                   " PRIMARY KEY (scale, x, y, z));");
  MapMetadata entries = {{"dimension", std::to_string(D)},
                         {"resolution", exactText(map.options().resolution)},
                         {"noise", exactText(map.options().noise)},
                         {"ratio", std::to_string(map.options().ratio)},
                         {"scales", std::to_string(map.scales())}};
  for (int s = 0; s < map.scales(); ++s) {
    entries["cells." + std::to_string(s)] = std::to_string(map.cellCount(s));
    entries["gaussians." + std::to_string(s)] = std::to_string(map.gaussianCount(s));
  }
  for (const auto& [name, value] : metadata) entries[kPrefix + name] = value;
  Statement insert_entry(database, "INSERT INTO metadata VALUES (?, ?)");
  for (const auto& [name, value] : entries) {
    insert_entry.bind(1, std::string_view(name));
    insert_entry.bind(2, std::string_view(value));
    insert_entry.step();
    insert_entry.reset();
  }
  Statement insert_tile(database, "INSERT INTO tiles VALUES (?, ?, ?, ?, ?, ?, ?)");
  for (int s = map.scales() - 1; s >= 0; --s) writeTiles<D>(map, s, options, insert_tile);
  database.execute("COMMIT");
}

}  // namespace

template <int D>
void saveMap(const GaussianMap<D>& map, const std::filesystem::path& path, const MapMetadata& metadata,
             const SaveOptions& options) {
  std::error_code error;
  if (!options.overwrite && std::filesystem::exists(path, error)) throw FileError(path, "exists already and is kept");
  AtomicFile file(path);
  {
    Database database(file.partPath(), Database::Mode::CreateForBulkWrite);
    writeMap<D>(database, map, metadata, options);
  }
  file.commit();
}

template <int D>
std::uintmax_t savedSize(const GaussianMap<D>& map, const MapMetadata& metadata, const SaveOptions& options) {
  Database database("map in memory", Database::Mode::InMemory);
  writeMap<D>(database, map, metadata, options);
  const auto pragma = [&](const std::string& name) {
    Statement statement(database, "PRAGMA " + name);
    statement.step();
    return static_cast<std::uintmax_t>(statement.integer(0));
  };
  return pragma("page_count") * pragma("page_size");
}

template <int D>
GaussianMap<D> loadMap(const std::filesystem::path& path) {
  const Database database = openMap(path);
  const MapMetadata metadata = readMetadata(database);
  const MetadataReader reader(path, metadata);
  if (reader.number<int>("dimension") != D)
    throw FileError(path, "holds a map of dimension " + std::to_string(reader.number<int>("dimension")) +
                              ", asked for is " + std::to_string(D));
  const MapOptions options{reader.number<double>("resolution"), reader.number<int>("ratio"),
                           reader.number<int>("scales"), reader.number<double>("noise")};
  try {
    const Grid<D> grid(options);
    std::vector<MapScale<D>> scales(static_cast<std::size_t>(options.scales));
    for (int s = options.scales - 1; s >= 0; --s) {
      OrderedScale<D> ordered = inKeyOrder<D>(readTiles<D>(database, s, options), options, s);
      const auto stated = reader.number<std::size_t>("cells." + std::to_string(s));
      if (ordered.scale.keys.size() != stated)
        throw std::invalid_argument("scale " + std::to_string(s) + " has " + std::to_string(ordered.scale.keys.size()) +
                                    " cells where " + std::to_string(stated) + " were saved");
      scales[static_cast<std::size_t>(s)] = std::move(ordered.scale);
      if (s + 1 < options.scales)
        link<D>(scales[static_cast<std::size_t>(s)], ordered.labels, scales[static_cast<std::size_t>(s) + 1], grid,
                s + 1);
    }
    return GaussianMap<D>(options, std::move(scales));
  } catch (const std::invalid_argument& error) {
    throw FileError(path, std::string("is damaged: ") + error.what());
  }
}

MapMetadata loadMetadata(const std::filesystem::path& path) {
  const Database database = openMap(path);
  MapMetadata own;
  const std::string prefix = kPrefix;
  for (const auto& [name, value] : readMetadata(database))
    if (name.compare(0, prefix.size(), prefix) == 0) own[name.substr(prefix.size())] = value;
  return own;
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

template void saveMap<2>(const GaussianMap<2>&, const std::filesystem::path&, const MapMetadata&, const SaveOptions&);
template void saveMap<3>(const GaussianMap<3>&, const std::filesystem::path&, const MapMetadata&, const SaveOptions&);
template std::uintmax_t savedSize<2>(const GaussianMap<2>&, const MapMetadata&, const SaveOptions&);
template std::uintmax_t savedSize<3>(const GaussianMap<3>&, const MapMetadata&, const SaveOptions&);
template GaussianMap<2> loadMap<2>(const std::filesystem::path&);
template GaussianMap<3> loadMap<3>(const std::filesystem::path&);

}  // namespace gaussmap
