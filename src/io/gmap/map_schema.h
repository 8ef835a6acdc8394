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

// What a .gmap looks like inside: the rows of its tables, named once for all who read and write them.
namespace gaussmap::detail {

inline constexpr const char* kUserPrefix = "user.";  // of the caller's metadata, so that names cannot collide

/// Cells along the side of a tile: a power of the ratio, so that a tile is a block of whole parents.
std::int32_t tileSpan(const MapOptions& options);

/// The tile that a cell lies in.
template <int D>
CellKey<D> tileOf(const CellKey<D>& key, std::int32_t span);

/// Tells a file from another that takes its place later.
struct FileIdentity {
  std::uint64_t device = 0, inode = 0, bytes = 0;
  std::int64_t changed = 0;  // [ns]
  friend bool operator==(const FileIdentity& a, const FileIdentity& b) {
    return a.device == b.device && a.inode == b.inode && a.bytes == b.bytes && a.changed == b.changed;
  }
};
/// Throws FileError if there is no such file.
FileIdentity identityOf(const std::filesystem::path& path);

/// Opens a map file and checks whose it is.
Database openMap(const std::filesystem::path& path, Database::Mode mode = Database::Mode::ReadOnly);

/// All metadata of a file, the caller's with their prefix.
MapMetadata readEntries(const Database& database);
/// Those of the caller, without it.
MapMetadata userEntries(const MapMetadata& entries);
void writeEntries(Database& database, const MapMetadata& entries);

/// What the file itself tells of a map; the numbers of cells and Gaussians by scale, finest first.
template <int D>
MapMetadata ownEntries(const MapOptions& options, const std::vector<std::size_t>& cells,
                       const std::vector<std::size_t>& gaussians);

/// A number among the metadata. Throws FileError if it is none.
template <typename Number>
Number numberIn(const std::filesystem::path& path, const MapMetadata& entries, const std::string& name) {
  const auto entry = entries.find(name);
  if (entry == entries.end()) throw FileError(path, "its metadata lack '" + name + "'");
  Number value{};
  const char* end = entry->second.data() + entry->second.size();
  const auto [stop, error] = std::from_chars(entry->second.data(), end, value);
  if (error != std::errc() || stop != end)
    throw FileError(path, "its metadata give '" + entry->second + "' for '" + name + "'");
  return value;
}

/// The options that the metadata tell. Throws FileError if they are of another dimension.
template <int D>
MapOptions readOptions(const std::filesystem::path& path, const MapMetadata& entries);

/// Makes the tables of a map file; opens a transaction.
void beginMap(Database& database);

/// One row of the table of tiles.
template <int D>
struct TileRow {
  int scale = 0;
  CellKey<D> tile{};
  std::size_t cells = 0;
  std::size_t gaussians = 0;
  std::string bytes;  ///< of encodeTile()
};

/// Writes tiles, replacing those of the same address.
template <int D>
class TileInsert {
 public:
  explicit TileInsert(const Database& database)
      : insert_(database, "INSERT OR REPLACE INTO tiles VALUES (?, ?, ?, ?, ?, ?, ?)") {}
  void write(const TileRow<D>& row);

 private:
  Statement insert_;
};

/// Addresses of tiles of one scale whose coordinates lie in [low, high], in x, y, z order.
template <int D>
std::vector<CellKey<D>> tilesWithin(const Database& database, int scale, const CellKey<D>& low, const CellKey<D>& high);

/// Reads tiles one by one.
template <int D>
class TileSelect {
 public:
  explicit TileSelect(const Database& database)
      : select_(database, "SELECT data FROM tiles WHERE scale = ? AND x = ? AND y = ? AND z = ?") {}
  /// The bytes of a tile, to be decoded; "" if there is no such tile.
  std::string read(int scale, const CellKey<D>& tile);

 private:
  Statement select_;
};

/// decodeTile() whose complaint names file and tile. Throws FileError.
template <int D>
Tile<D> decodeRow(const std::filesystem::path& path, std::string_view bytes, const TileAddress<D>& address,
                  const MapOptions& options);

}  // namespace gaussmap::detail
