// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "gaussmap/core/error.h"
#include "gaussmap/io/gmap/map_file.h"
#include "io/gmap/sqlite.h"
#include "io/gmap/tile_codec.h"

// The SQLite tables of a .gmap file, for all code that reads or writes them.
namespace gaussmap::detail {

inline constexpr const char* kUserPrefix = "user.";  // prefix of the caller's entries, so that names cannot collide

/// Returns the number of cells along the side of a tile. It is a power of the ratio, so the children of a cell are all
/// in the same tile.
std::int32_t tileSpan(const MapOptions& options);

/// Returns the tile that contains a cell.
template <int D>
CellKey<D> tileOf(const CellKey<D>& key, std::int32_t span);

/// Identity of a file. It shows whether another file has replaced it.
struct FileIdentity {
  std::uint64_t device = 0, inode = 0, bytes = 0;
  std::int64_t changed = 0;  // [ns]
  friend bool operator==(const FileIdentity& a, const FileIdentity& b) {
    return a.device == b.device && a.inode == b.inode && a.bytes == b.bytes && a.changed == b.changed;
  }
};
/// Returns the identity of a file. Throws FileError if the file does not exist.
FileIdentity identityOf(const std::filesystem::path& path);

/// Opens a map file and checks its application id and schema version. Throws FileError if it is not a map.
Database openMap(const std::filesystem::path& path, Database::Mode mode = Database::Mode::ReadOnly);

/// Reads all metadata of a file. The caller's entries have the prefix kUserPrefix.
MapMetadata readEntries(const Database& database);
/// Returns only the caller's entries, without the prefix.
MapMetadata userEntries(const MapMetadata& entries);
void writeEntries(Database& database, const MapMetadata& entries);

/// Returns the entries that describe a map. `cells` and `gaussians` are the numbers per scale, finest first.
template <int D>
MapMetadata ownEntries(const MapOptions& options, const std::vector<std::size_t>& cells,
                       const std::vector<std::size_t>& gaussians);

/// Returns a number from the metadata. Throws FileError if the entry is missing or is not a number.
template <typename Number>
Number numberIn(const std::filesystem::path& path, const MapMetadata& entries, const std::string& name) {
  const auto entry = entries.find(name);
  if (entry == entries.end()) throw FileError(path, "has no metadata entry '" + name + "'");
  Number value{};
  const char* end = entry->second.data() + entry->second.size();
  const auto [stop, error] = std::from_chars(entry->second.data(), end, value);
  if (error != std::errc() || stop != end)
    throw FileError(path, "has the metadata entry '" + name + "' = '" + entry->second + "', expected a number");
  return value;
}

/// Returns the map options from the metadata. Throws FileError if the map has another dimension.
template <int D>
MapOptions readOptions(const std::filesystem::path& path, const MapMetadata& entries);

/// Opens a transaction and creates the tables of a map file.
void beginMap(Database& database);

/// One row of the table `tiles`.
template <int D>
struct TileRow {
  int scale = 0;
  CellKey<D> tile{};
  std::size_t cells = 0;
  std::size_t gaussians = 0;
  std::string bytes;  ///< the result of encodeTile()
};

/// Writes tiles. A tile with the same address is replaced.
template <int D>
class TileInsert {
 public:
  explicit TileInsert(const Database& database)
      : insert_(database, "INSERT OR REPLACE INTO tiles VALUES (?, ?, ?, ?, ?, ?, ?)") {}
  void write(const TileRow<D>& row);

 private:
  Statement insert_;
};

/// Returns the addresses of the tiles of one scale whose coordinates lie in [low, high], in x, y, z order.
template <int D>
std::vector<CellKey<D>> tilesWithin(const Database& database, int scale, const CellKey<D>& low, const CellKey<D>& high);

/// Reads tiles one by one.
template <int D>
class TileSelect {
 public:
  explicit TileSelect(const Database& database)
      : select_(database, "SELECT data FROM tiles WHERE scale = ? AND x = ? AND y = ? AND z = ?") {}
  /// Returns the encoded bytes of a tile; "" if the tile does not exist.
  std::string read(int scale, const CellKey<D>& tile);

 private:
  Statement select_;
};

/// Decodes a tile with decodeTile(). Throws FileError with the file and the tile if this fails.
template <int D>
Tile<D> decodeRow(const std::filesystem::path& path, std::string_view bytes, const TileAddress<D>& address,
                  const MapOptions& options);

}  // namespace gaussmap::detail
