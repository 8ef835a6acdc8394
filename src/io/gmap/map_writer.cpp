// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <vector>

#include "core/parallel.h"
#include "io/files/atomic_file.h"
#include "io/gmap/make_tiles.h"
#include "io/gmap/map_schema.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr const char* kFinalText =
    "means within 1/16 standard deviation along each axis, standard deviations within 5 % in every direction, weights "
    "and log-odds within 1/32";
constexpr std::size_t kTilesAtOnce = 256;  // number of tiles compressed at once; limits the memory of a save

template <int D>
void writeTiles(const GaussianMap<D>& map, int s, const SaveOptions& options, TileInsert<D>& insert) {
  const std::int32_t span = tileSpan(map.options());
  const auto tiles = cellsByTile<D>(map.scale(s), span);
  std::vector<TileRow<D>> rows;
  std::vector<const std::vector<IndexRange>*> runs;
  for (auto next = tiles.begin(); next != tiles.end();) {
    rows.clear();
    runs.clear();
    for (; next != tiles.end() && rows.size() < kTilesAtOnce; ++next) {
      rows.push_back({s, next->first, 0, 0, {}});
      runs.push_back(&next->second);
    }
    parallelFor(rows.size(), options.threads, 1, [&](std::size_t i) {
      const Tile<D> tile = makeTile<D>(map, s, *runs[i]);
      rows[i].cells = tile.keys.size();
      rows[i].gaussians = tile.gaussianCount();
      rows[i].bytes =
          encodeTile<D>(tile, {s, rows[i].tile, span}, map.options(), options.compression, options.precision);
    });
    for (const TileRow<D>& row : rows) insert.write(row);
  }
}

template <int D>
void writeMap(Database& database, const GaussianMap<D>& map, const MapMetadata& metadata, const SaveOptions& options) {
  beginMap(database);
  std::vector<std::size_t> cells, gaussians;
  for (int s = 0; s < map.scales(); ++s) {
    cells.push_back(map.cellCount(s));
    gaussians.push_back(map.gaussianCount(s));
  }
  MapMetadata entries = ownEntries<D>(map.options(), cells, gaussians);
  const bool is_final = options.precision == Precision::Finished;
  entries["grows"] = map.acceptsScans() && !is_final ? "1" : "0";
  entries["occupancy"] = map.hasOccupancy() ? "1" : "0";
  for (const auto& [name, value] : metadata)
    if (name != kFinalEntry) entries[kUserPrefix + name] = value;
  if (is_final) entries[std::string(kUserPrefix) + kFinalEntry] = kFinalText;
  writeEntries(database, entries);
  TileInsert<D> insert(database);
  for (int s = map.scales() - 1; s >= 0; --s) writeTiles<D>(map, s, options, insert);
  database.execute("COMMIT");
}

}  // namespace

template <int D>
void save(const std::filesystem::path& path, const GaussianMap<D>& map, const MapMetadata& metadata,
          const SaveOptions& options) {
  std::error_code error;
  if (!options.overwrite && std::filesystem::exists(path, error))
    throw FileError(path, "exists already and is not overwritten");
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

template void save<2>(const std::filesystem::path&, const GaussianMap<2>&, const MapMetadata&, const SaveOptions&);
template void save(const std::filesystem::path&, const GaussianMap<3>&, const MapMetadata&, const SaveOptions&);
template std::uintmax_t savedSize<2>(const GaussianMap<2>&, const MapMetadata&, const SaveOptions&);
template std::uintmax_t savedSize<3>(const GaussianMap<3>&, const MapMetadata&, const SaveOptions&);

}  // namespace gaussmap
