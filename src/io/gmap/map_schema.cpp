// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/map_schema.h"

#include <sys/stat.h>

#include <fstream>
#include <optional>
#include <utility>

#include "core/floor_divide.h"

namespace gaussmap::detail {
namespace {

constexpr std::int32_t kMinSpan = 32;

/// Returns the shortest text that reads back as the same double, in any locale.
std::string exactText(double value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Binds x, y, z to three consecutive parameters. A 2-D map has z = 0.
template <int D>
void bindTile(Statement& statement, int first, const CellKey<D>& tile) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    statement.bind(first + static_cast<int>(axis), axis < D ? std::int64_t{tile[axis]} : std::int64_t{0});
}

/// Opens the file once. openMap() tries again if the file was replaced meanwhile.
Database openOnce(const std::filesystem::path& path, Database::Mode mode) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw FileError(path, "does not exist");
  if (!std::filesystem::is_regular_file(path, error)) throw FileError(path, "is not a file");
  const std::string start = "SQLite format 3";
  std::string head(start.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(path, "cannot be opened for reading");
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (file.gcount() == 0) throw FileError(path, "is empty");
  if (head != start) throw FileError(path, "is not a map: it does not start like a .gmap file");
  Database database(path, mode);
  Statement id(database, "PRAGMA application_id");
  if (!id.step() || id.integer(0) != kMapFileId) throw FileError(path, "is an SQLite database, but not a gaussmap map");
  Statement version(database, "PRAGMA user_version");
  if (!version.step() || version.integer(0) != kMapFileVersion)
    throw FileError(path, "has schema version " + std::to_string(version.integer(0)) + ", this program reads version " +
                              std::to_string(kMapFileVersion) + ": use the gaussmap that wrote it");
  return database;
}

}  // namespace

std::int32_t tileSpan(const MapOptions& options) {
  std::int64_t span = options.ratio;
  while (span < kMinSpan) span *= options.ratio;
  return static_cast<std::int32_t>(span);
}

template <int D>
CellKey<D> tileOf(const CellKey<D>& key, std::int32_t span) {
  CellKey<D> tile;
  for (std::size_t axis = 0; axis < D; ++axis) tile[axis] = static_cast<std::int32_t>(floorDivide(key[axis], span));
  return tile;
}

FileIdentity identityOf(const std::filesystem::path& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) throw FileError(path, "does not exist");
  return {std::uint64_t(status.st_dev), std::uint64_t(status.st_ino), std::uint64_t(status.st_size),
          std::int64_t{status.st_mtim.tv_sec} * 1000000000 + status.st_mtim.tv_nsec};
}

Database openMap(const std::filesystem::path& path, Database::Mode mode) {
  for (;;) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) throw FileError(path, "does not exist");
    const FileIdentity before = identityOf(path);
    std::optional<Database> database;
    try {
      database.emplace(openOnce(path, mode));
    } catch (const FileError&) {
      if (identityOf(path) == before) throw;
    }
    if (database && identityOf(path) == before) return std::move(*database);
  }
}

MapMetadata readEntries(const Database& database) {
  MapMetadata metadata;
  Statement select(database, "SELECT name, value FROM metadata");
  while (select.step()) metadata[select.text(0)] = select.text(1);
  return metadata;
}

MapMetadata userEntries(const MapMetadata& entries) {
  MapMetadata own;
  const std::string prefix = kUserPrefix;
  for (const auto& [name, value] : entries)
    if (name.compare(0, prefix.size(), prefix) == 0) own[name.substr(prefix.size())] = value;
  return own;
}

void writeEntries(Database& database, const MapMetadata& entries) {
  Statement insert(database, "INSERT INTO metadata VALUES (?, ?)");
  for (const auto& [name, value] : entries) {
    insert.bind(1, std::string_view(name));
    insert.bind(2, std::string_view(value));
    insert.step();
    insert.reset();
  }
}

template <int D>
MapMetadata ownEntries(const MapOptions& options, const std::vector<std::size_t>& cells,
                       const std::vector<std::size_t>& gaussians) {
  MapMetadata entries = {{"dimension", std::to_string(D)},
                         {"resolution", exactText(options.resolution)},
                         {"noise", exactText(options.noise)},
                         {"ratio", std::to_string(options.ratio)},
                         {"scales", std::to_string(options.scales)}};
  for (std::size_t s = 0; s < cells.size(); ++s) {
    entries["cells." + std::to_string(s)] = std::to_string(cells[s]);
    entries["gaussians." + std::to_string(s)] = std::to_string(gaussians[s]);
  }
  return entries;
}

template <int D>
MapOptions readOptions(const std::filesystem::path& path, const MapMetadata& entries) {
  const int dimension = numberIn<int>(path, entries, "dimension");
  if (dimension != D)
    throw FileError(path, "holds a map of dimension " + std::to_string(dimension) + ", expected " + std::to_string(D));
  return {numberIn<double>(path, entries, "resolution"), numberIn<int>(path, entries, "ratio"),
          numberIn<int>(path, entries, "scales"), numberIn<double>(path, entries, "noise")};
}

void beginMap(Database& database) {
  database.execute("PRAGMA application_id = " + std::to_string(kMapFileId) +
                   "; PRAGMA user_version = " + std::to_string(kMapFileVersion) +
                   "; BEGIN;"
                   "CREATE TABLE metadata (name TEXT PRIMARY KEY, value TEXT NOT NULL);"
                   "CREATE TABLE tiles (scale INTEGER NOT NULL, x INTEGER NOT NULL, y INTEGER NOT NULL,"
                   " z INTEGER NOT NULL, cells INTEGER NOT NULL, gaussians INTEGER NOT NULL, data BLOB NOT NULL,"
                   " PRIMARY KEY (scale, x, y, z));");
}

template <int D>
void TileInsert<D>::write(const TileRow<D>& row) {
  insert_.bind(1, std::int64_t{row.scale});
  bindTile<D>(insert_, 2, row.tile);
  insert_.bind(5, static_cast<std::int64_t>(row.cells));
  insert_.bind(6, static_cast<std::int64_t>(row.gaussians));
  insert_.bindBlob(7, row.bytes);
  insert_.step();
  insert_.reset();
}

template <int D>
std::vector<CellKey<D>> tilesWithin(const Database& database, int scale, const CellKey<D>& low,
                                    const CellKey<D>& high) {
  Statement select(database,
                   "SELECT x, y, z FROM tiles WHERE scale = ? AND x >= ? AND y >= ? AND z >= ? AND x <= ? AND y <= ? "
                   "AND z <= ? ORDER BY x, y, z");
  select.bind(1, std::int64_t{scale});
  bindTile<D>(select, 2, low);
  bindTile<D>(select, 5, high);
  std::vector<CellKey<D>> tiles;
  while (select.step()) {
    CellKey<D> tile;  // within [low, high], so it fits
    for (std::size_t axis = 0; axis < D; ++axis)
      tile[axis] = static_cast<std::int32_t>(select.integer(static_cast<int>(axis)));
    if (!tiles.empty() && !(tiles.back() < tile))
      throw FileError(database.path(), "is damaged: tiles are out of order or occur twice");
    tiles.push_back(tile);
  }
  return tiles;
}

template <int D>
std::string TileSelect<D>::read(int scale, const CellKey<D>& tile) {
  select_.bind(1, std::int64_t{scale});
  bindTile<D>(select_, 2, tile);
  std::string bytes;
  if (select_.step()) bytes = select_.blob(0);
  select_.reset();
  return bytes;
}

template <int D>
Tile<D> decodeRow(const std::filesystem::path& path, std::string_view bytes, const TileAddress<D>& address,
                  const MapOptions& options) {
  try {
    return decodeTile<D>(bytes, address, options);
  } catch (const std::runtime_error& error) {
    throw FileError(path, "tile " + toString<D>(address.tile) + " of scale " + std::to_string(address.scale) +
                              " is damaged: " + error.what());
  }
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                  \
  template CellKey<D> tileOf<D>(const CellKey<D>&, std::int32_t);                                                \
  template MapMetadata ownEntries<D>(const MapOptions&, const std::vector<std::size_t>&,                         \
                                     const std::vector<std::size_t>&);                                           \
  template MapOptions readOptions<D>(const std::filesystem::path&, const MapMetadata&);                          \
  template class TileInsert<D>;                                                                                  \
  template class TileSelect<D>;                                                                                  \
  template std::vector<CellKey<(D)>> tilesWithin<D>(const Database&, int, const CellKey<D>&, const CellKey<D>&); \
  template Tile<D> decodeRow<D>(const std::filesystem::path&, std::string_view, const TileAddress<D>&,           \
                                const MapOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
