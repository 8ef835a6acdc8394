// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/gmap/map_update.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/parallel.h"
#include "gaussmap/io/gmap/map_file.h"
#include "io/files/atomic_file.h"
#include "io/gmap/assemble_map.h"
#include "io/gmap/make_tiles.h"
#include "io/gmap/map_schema.h"
#include "mapping/update_part.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kTilesEncoded = 256;  // number of tiles encoded at once

/// The metadata of the map file to be updated.
template <int D>
struct Header {
  MapMetadata entries;
  MapOptions options;
  bool occupancy = false;
  std::vector<std::size_t> cells, gaussians;

  Header(const std::filesystem::path& path, const Database& database) : entries(readEntries(database)) {
    options = readOptions<D>(path, entries);
    if (entries.count("grows") + entries.count("occupancy") == 0) {  // first versions: only the tiles show this
      const GaussianMap<D> map = load<D>(path);
      entries["grows"] = map.acceptsScans() ? "1" : "0";
      entries["occupancy"] = map.hasOccupancy() ? "1" : "0";
    }
    if (numberIn<int>(path, entries, "grows") != 1)
      throw FileError(path,
                      "accepts no more scans: it is final, compressed or learnt, so it has no moments; update the map "
                      "that it was made from");
    occupancy = numberIn<int>(path, entries, "occupancy") != 0;
    try {
      options = Grid<D>(options).options();
    } catch (const std::invalid_argument& error) {
      throw FileError(path, std::string("is damaged: ") + error.what());
    }
    for (int s = 0; s < options.scales; ++s) {
      cells.push_back(numberIn<std::size_t>(path, entries, "cells." + std::to_string(s)));
      gaussians.push_back(numberIn<std::size_t>(path, entries, "gaussians." + std::to_string(s)));
    }
  }
};

/// A tile as it is in the file.
template <int D>
struct OldTile {
  Tile<D> all;
  Tile<D> outside;  // its cells that are not under the coarsest cells with new points
};
template <int D>
using OldTiles = std::map<CellKey<D>, OldTile<D>>;

template <int D>
bool sameTile(const Tile<D>& a, const Tile<D>& b) {
  const auto same = [](const Gaussian<D>& g, const Gaussian<D>& h) {
    return g.mean == h.mean && g.cov == h.cov && g.weight == h.weight;
  };
  return a.keys == b.keys && a.counts == b.counts && a.moments == b.moments && a.labels == b.labels &&
         a.log_odds == b.log_odds &&
         std::equal(a.gaussians.begin(), a.gaussians.end(), b.gaussians.begin(), b.gaussians.end(), same);
}

/// Sorts the cells into the order that save() uses.
template <int D>
Tile<D> sortedTile(const Tile<D>& tile, const MapOptions& options, int s) {
  std::vector<std::size_t> first(tile.keys.size() + 1, 0);
  for (std::size_t i = 0; i < tile.counts.size(); ++i) first[i + 1] = first[i] + tile.counts[i];
  Tile<D> sorted;
  for (const std::uint32_t from : keyOrder<D>(tile.keys, options.ratio, options.scales - 1 - s)) {
    sorted.keys.push_back(tile.keys[from]);
    sorted.counts.push_back(tile.counts[from]);
    if (!tile.moments.empty()) sorted.moments.push_back(tile.moments[from]);
    for (std::size_t i = first[from]; i < first[from + 1]; ++i) {
      if (!tile.gaussians.empty()) sorted.gaussians.push_back(tile.gaussians[i]);
      if (!tile.labels.empty()) sorted.labels.push_back(tile.labels[i]);
      if (!tile.log_odds.empty()) sorted.log_odds.push_back(tile.log_odds[i]);
    }
  }
  return sorted;
}

/// Returns true if all sums of `whole` are those of `part`, times the same whole number.
template <int D>
bool isMultiple(const CellMoments<D>& whole, const CellMoments<D>& part) {
  const std::int64_t times = whole.count / part.count;
  const auto fits = [times](const auto& a, const auto& b) {
    return std::equal(a.begin(), a.end(), b.begin(),
                      [times](std::int64_t x, std::int64_t y) { return x == times * y; });
  };
  return times > 0 && whole.count == times * part.count && fits(whole.sum, part.sum) &&
         fits(whole.product, part.product);
}

template <int D>
class Updater {
 public:
  Updater(Database& database, const std::filesystem::path& path, const MomentGrid<D>& added,
          const UpdateOptions& options)
      : database_(database),
        path_(path),
        header_(path, database),
        grid_(header_.options),
        added_(added),
        options_(options),
        span_(tileSpan(header_.options)),
        old_(std::size_t(grid_.scales())) {
    if (added.resolution() != header_.options.resolution) {
      std::ostringstream text;
      text << "points counted in cells of " << added.resolution() << " m cannot be added to cells of "
           << header_.options.resolution << " m";
      throw std::invalid_argument(text.str());
    }
    for (std::size_t i = 0; i < added.size(); ++i) roots_.insert(grid_.ancestor(added[i].key, 0, grid_.scales() - 1));
  }

  MapUpdate run(const std::function<void(MapMetadata&)>& edit) {
    const GaussianMap<D> before = readPart();
    RefineOptions refining;
    refining.merge_cost = options_.merge_cost;
    refining.threads = options_.threads;
    const GaussianMap<D> after =
        updatePart<D>(before, added_, header_.occupancy, refining, [&](int s, std::size_t cells) {
          const auto at = static_cast<std::size_t>(s);
          const std::size_t others = header_.gaussians[at] - before.gaussianCount(s);
          const std::size_t most = maxGaussians(at, header_.cells[at] - before.cellCount(s) + cells);
          return most - std::min(most, others);
        });
    database_.execute("BEGIN");
    MapUpdate update;
    compare(before, update);
    for (int s = grid_.scales() - 1; s >= 0; --s) update.tiles_written += writeTiles(after, s);
    for (int s = 0; s < grid_.scales(); ++s) {
      const auto at = static_cast<std::size_t>(s);
      update.cells.push_back(header_.cells[at] - before.cellCount(s) + after.cellCount(s));
      update.gaussians.push_back(header_.gaussians[at] - before.gaussianCount(s) + after.gaussianCount(s));
    }
    writeHeader(update, edit);
    database_.execute("COMMIT");
    Statement count(database_, "SELECT COUNT(*) FROM tiles");
    count.step();
    update.tiles = static_cast<std::size_t>(count.integer(0));
    return update;
  }

 private:
  /// Counts the cells that already held the new points.
  void compare(const GaussianMap<D>& before, MapUpdate& update) const {
    update.cells_added_to = added_.size();
    for (std::size_t i = 0; i < added_.size(); ++i) {
      const CellMoments<D>& fresh = added_[i].moments;
      const auto known = before.find(added_[i].key, 0);
      const bool is_repeated = known && isMultiple<D>(before.scale(0).moments[*known], fresh),
                 is_dense = fresh.count >= kDensePoints;
      update.cells_repeated += is_repeated;
      update.dense_cells += is_dense;
      update.dense_cells_repeated += is_dense && is_repeated;
    }
  }

  /// Returns the maximum number of Gaussians of a coarse scale of the whole map if the scale has this many cells.
  std::size_t maxGaussians(std::size_t s, std::size_t cells) const {
    constexpr double kRounding = 1e-9;
    const double per_cell = options_.budget ? *options_.budget
                                            : static_cast<double>(header_.gaussians[s]) /
                                                  static_cast<double>(std::max<std::size_t>(header_.cells[s], 1));
    const double most = std::floor(per_cell * static_cast<double>(cells) * (1.0 + kRounding));
    return static_cast<std::size_t>(std::clamp(most, static_cast<double>(cells), 4294967295.0));
  }

  /// Adds the tiles of scale s that contain descendants of a coarsest cell.
  void addTilesUnder(const CellKey<D>& root, int s, std::set<CellKey<D>>& tiles) const {
    const std::int64_t span = grid_.cellsAlongSide(grid_.scales() - 1) / grid_.cellsAlongSide(s);
    CellKey<D> low, high;
    for (std::size_t axis = 0; axis < D; ++axis) {
      constexpr std::int64_t kMin = std::numeric_limits<std::int32_t>::min(),
                             kMax = std::numeric_limits<std::int32_t>::max();
      const std::int64_t first = std::int64_t{root[axis]} * span;
      low[axis] = static_cast<std::int32_t>(std::clamp(first, kMin, kMax));
      high[axis] = static_cast<std::int32_t>(std::clamp(first + span - 1, kMin, kMax));
    }
    low = tileOf<D>(low, span_);
    high = tileOf<D>(high, span_);
    if (low == high)  // nearly always; a query would take longer than everything else
      tiles.insert(low);
    else
      for (const CellKey<D>& tile : tilesWithin<D>(database_, s, low, high)) tiles.insert(tile);
  }

  /// Reads the coarsest cells that get new points, with all their descendants.
  GaussianMap<D> readPart() {
    TileSelect<D> select(database_);
    std::vector<Tile<D>> part(old_.size());
    for (int s = 0; s < grid_.scales(); ++s) {
      const auto at = static_cast<std::size_t>(s);
      std::set<CellKey<D>> tiles;
      for (const CellKey<D>& root : roots_) addTilesUnder(root, s, tiles);
      for (const CellKey<D>& tile : tiles) {
        const std::string bytes = select.read(s, tile);
        if (bytes.empty()) continue;
        OldTile<D>& old = old_[at][tile];
        old.all = decodeRow<D>(path_, bytes, {s, tile, span_}, header_.options);
        if (s == 0 && old.all.moments.empty()) throw FileError(path_, "is damaged: a finest tile has no moments");
        const auto isInside = [&](const CellKey<D>& key) {
          return roots_.count(grid_.ancestor(key, s, grid_.scales() - 1)) > 0;
        };
        appendCells<D>(part[at], old.all, isInside);
        appendCells<D>(old.outside, old.all, [&](const CellKey<D>& key) { return !isInside(key); });
      }
    }
    try {
      GaussianMap<D> map = assembleMap<D>(header_.options, std::move(part));
      bool fits = map.acceptsScans() && (map.empty() || map.hasOccupancy() == header_.occupancy);
      for (int s = 0; s < grid_.scales(); ++s)
        fits &= map.cellCount(s) <= header_.cells[std::size_t(s)] &&
                map.gaussianCount(s) <= header_.gaussians[std::size_t(s)];
      if (!fits) throw std::invalid_argument("its tiles do not match its metadata");
      return map;
    } catch (const std::invalid_argument& error) {
      throw FileError(path_, std::string("is damaged: ") + error.what());
    }
  }

  /// Writes the tiles of a scale that have changed. Returns their number.
  std::size_t writeTiles(const GaussianMap<D>& after, int s) {
    const OldTiles<D>& old = old_[static_cast<std::size_t>(s)];
    const auto cut = cellsByTile<D>(after.scale(s), span_);
    std::vector<const std::pair<const CellKey<D>, std::vector<IndexRange>>*> all;
    all.reserve(cut.size());
    for (const auto& entry : cut) all.push_back(&entry);
    TileInsert<D> insert(database_);
    std::size_t written = 0;
    for (std::size_t begin = 0; begin < all.size(); begin += kTilesEncoded) {
      std::vector<TileRow<D>> rows(std::min(kTilesEncoded, all.size() - begin));
      parallelFor(rows.size(), options_.threads, 1, [&](std::size_t i) {
        const auto& [address, runs] = *all[begin + i];
        Tile<D> tile = makeTile<D>(after, s, runs);
        const auto before = old.find(address);
        if (before != old.end()) {
          if (!before->second.outside.keys.empty()) {
            appendTile<D>(tile, before->second.outside);
            tile = sortedTile<D>(tile, header_.options, s);
          }
          if (sameTile<D>(tile, before->second.all)) return;
        }
        rows[i] = {s, address, tile.keys.size(), tile.gaussianCount(),
                   encodeTile<D>(tile, {s, address, span_}, header_.options, options_.compression)};
      });
      for (const TileRow<D>& row : rows) {
        if (row.bytes.empty()) continue;
        insert.write(row);
        ++written;
      }
    }
    return written;
  }

  void writeHeader(const MapUpdate& update, const std::function<void(MapMetadata&)>& edit) {
    MapMetadata entries = ownEntries<D>(header_.options, update.cells, update.gaussians),
                user = userEntries(header_.entries);
    if (edit) edit(user);
    for (const char* const name : {"grows", "occupancy"}) entries[name] = header_.entries.at(name);
    for (const auto& [name, value] : user) entries[kUserPrefix + name] = value;
    database_.execute("DELETE FROM metadata");
    writeEntries(database_, entries);
  }

  Database& database_;
  const std::filesystem::path& path_;
  const Header<D> header_;
  const Grid<D> grid_;
  const MomentGrid<D>& added_;
  const UpdateOptions& options_;
  const std::int32_t span_;
  std::set<CellKey<D>> roots_;  // coarsest cells that get new points
  std::vector<OldTiles<D>> old_;
};

/// Copies the target to the part file. (If the disk is full, std::filesystem::copy_file() reports
/// only "Input/output error".)
void copyTarget(AtomicFile& file) {
  std::ifstream source(file.target(), std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 20);
  do {
    source.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    file.write(piece.data(), static_cast<std::size_t>(source.gcount()));
  } while (source);
  if (!source.eof()) throw FileError(file.target(), "cannot be read");
}

}  // namespace

template <int D>
MapUpdate updateMap(const std::filesystem::path& path, const MomentGrid<D>& added, const UpdateOptions& options,
                    const std::function<void(MapMetadata&)>& edit) {
  if (options.budget)
    require(std::isfinite(*options.budget) && *options.budget >= 1.0, "budget", *options.budget,
            "must be at least 1 Gaussian per cell");
  growingMapOptions<D>(path);  // throws before a part file is created
  AtomicFile file(path);       // from here on no other writer can replace the map
  copyTarget(file);
  MapUpdate update;
  {
    Database database = openMap(file.partPath(), Database::Mode::ChangeCopy);
    update = Updater<D>(database, path, added, options).run(edit);
  }
  file.commit();
  return update;
}

template <int D>
MapOptions growingMapOptions(const std::filesystem::path& path) {
  return Header<D>(path, openMap(path)).options;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                             \
  template MapUpdate updateMap<D>(const std::filesystem::path&, const MomentGrid<D>&, const UpdateOptions&, \
                                  const std::function<void(MapMetadata&)>&);                                \
  template MapOptions growingMapOptions<D>(const std::filesystem::path&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
