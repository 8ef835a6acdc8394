// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/gmap/build_map_file.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "core/check.h"
#include "core/parallel.h"
#include "io/files/atomic_file.h"
#include "io/gmap/largest_gains.h"
#include "io/gmap/map_schema.h"
#include "io/gmap/spilled_cells.h"
#include "map/coarsen.h"
#include "map/occupied_areas.h"
#include "mapping/budget.h"
#include "mapping/scale_clusters.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kShareOfSums = 0.6;      // share of the memory for the moments while scans are read
constexpr std::size_t kBatchesHeld = 24;  // memory of a batch during its processing, in multiples of its bytes

/// Returns freed memory to the system. Otherwise other threads cannot use the memory that one thread has freed.
void giveBackMemory() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

/// The dendrograms of one batch, on disk.
struct SpilledCuts {
  SpillFile::Span keys;   // keys of the coarse cells
  SpillFile::Span sizes;  // number of merges of each cell
  SpillFile::Span merges;
  SpillFile::Span gains;
};

/// A compressed tile, on disk.
template <int D>
struct SpilledTile {
  TileRow<D> row;  // without its bytes
  SpillFile::Span bytes;
};

template <typename Value>
std::vector<Value> arrayOf(const SpillFile& file, const SpillFile::Span& span) {
  std::vector<Value> values;
  std::size_t place = 0;
  takeArray(file.read(span), place, values);
  return values;
}

/// Computes how many clusters each cell of a scale gets.
template <int D>
class ScaleBudget {
 public:
  ScaleBudget(const SpillFile& file, const std::vector<SpilledCuts>& cuts, const MapOptions& options, int scale,
              std::size_t extra)
      : threshold_(largestGains(extra, [&](const std::function<void(double)>& visit) {
          for (const SpilledCuts& batch : cuts)
            for (const double gain : arrayOf<double>(file, batch.gains)) visit(gain);
        })) {
    if (threshold_.ties > 0) shareTies(file, cuts, options, scale);
  }

  std::size_t partsOf(const CellKey<D>& key, const std::vector<double>& gains) const {
    const auto falling = [](double a, double b) { return a > b; };
    const auto above = std::lower_bound(gains.begin(), gains.end(), threshold_.gain, falling) - gains.begin();
    const auto ties = ties_.find(key);
    return 1 + static_cast<std::size_t>(above) + (ties == ties_.end() ? 0 : ties->second);
  }

 private:
  /// Of equal gains, those of the first cells in key order are taken, as in partsPerCell().
  void shareTies(const SpillFile& file, const std::vector<SpilledCuts>& cuts, const MapOptions& options, int scale) {
    std::vector<CellKey<D>> keys;
    std::vector<std::size_t> counts;
    for (const SpilledCuts& batch : cuts) {
      const auto cells = arrayOf<CellKey<D>>(file, batch.keys);
      const auto sizes = arrayOf<std::uint32_t>(file, batch.sizes);
      const auto gains = arrayOf<double>(file, batch.gains);
      std::size_t first = 0;
      for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const auto begin = gains.begin() + static_cast<std::ptrdiff_t>(first);
        const auto count = std::count(begin, begin + sizes[cell], threshold_.gain);
        first += sizes[cell];
        if (count == 0) continue;
        keys.push_back(cells[cell]);
        counts.push_back(static_cast<std::size_t>(count));
      }
    }
    std::size_t left = threshold_.ties;
    for (const std::uint32_t from : keyOrder<D>(keys, options.ratio, options.scales - 1 - scale)) {
      ties_[keys[from]] = std::min(left, counts[from]);
      left -= std::min(left, counts[from]);
      if (left == 0) break;
    }
  }

  GainThreshold threshold_;
  std::map<CellKey<D>, std::size_t> ties_;
};

template <int D>
class Builder {
 public:
  Builder(const MapOptions& map, const std::filesystem::path& folder, const BuildMapFileOptions& options)
      : grid_(map),
        options_(options),
        span_(tileSpan(map)),
        batch_bytes_(options.max_memory / kBatchesHeld),
        spill_(folder),
        cells_(std::make_unique<SpilledCells<D>>(spill_, grid_.options(), 0)) {}

  void add(const MomentGrid<D>& moments) { cells_->add(moments); }

  void finishScales() {
    for (int s = 0; s < grid_.scales(); ++s) {
      cell_counts_.push_back(0);
      gaussian_counts_.push_back(0);
      tiles_.emplace_back();
      if (s + 1 == grid_.scales()) {
        for (const auto& tiles : cells_->batches(batch_bytes_)) keepTiles(cells_->load(tiles, threads()), nullptr, s);
      } else {
        auto coarser = std::make_unique<SpilledCells<D>>(spill_, grid_.options(), s + 1);
        finishScale(s, *coarser);
        cells_ = std::move(coarser);
      }
    }
  }

  void write(Database& database, const MapMetadata& metadata) const {
    beginMap(database);
    MapMetadata entries = ownEntries<D>(grid_.options(), cell_counts_, gaussian_counts_);
    entries["grows"] = "1";
    entries["occupancy"] = "0";
    for (const auto& [name, value] : metadata) entries[kUserPrefix + name] = value;
    writeEntries(database, entries);
    TileInsert<D> insert(database);
    for (int s = grid_.scales() - 1; s >= 0; --s)
      for (const SpilledTile<D>& tile : tiles_[static_cast<std::size_t>(s)]) {
        TileRow<D> row = tile.row;
        row.bytes = spill_.read(tile.bytes);
        insert.write(row);
      }
    database.execute("COMMIT");
  }

  const std::vector<std::size_t>& cellCounts() const { return cell_counts_; }
  const std::vector<std::size_t>& gaussianCounts() const { return gaussian_counts_; }

 private:
  int threads() const { return options_.refine.threads; }
  bool refines() const {
    const auto* per_cell = std::get_if<PerCell>(&options_.budget);
    return per_cell == nullptr || per_cell->gaussians != 1.0;
  }

  /// Builds the next coarser scale. Then stores the tiles of scale s, because the parents of their Gaussians
  /// are now known.
  void finishScale(int s, SpilledCells<D>& coarser) {
    const auto batches = cells_->batches(batch_bytes_);
    std::vector<SpilledCuts> cuts;
    std::optional<ScaleBudget<D>> budget;
    if (refines()) {
      std::size_t coarse_cells = 0, gaussians = 0;
      for (const auto& tiles : batches) {
        giveBackMemory();
        CellBatch<D> batch = cells_->load(tiles, threads());
        MapScale<D> coarse = coarsen<D>(batch.cells, grid_, s);
        const ScalePair<D> pair{batch.cells, coarse, grid_, s};
        cuts.push_back(
            keepCuts(coarse.keys, ScaleClusters::under(pair, batch.areas, options_.refine.merge_cost, threads())));
        coarse_cells += coarse.keys.size();
        gaussians += batch.cells.gaussianCount();
      }
      budget.emplace(spill_, cuts, grid_.options(), s + 1,
                     extraGaussians(options_.budget, s + 1, coarse_cells, gaussians));
    }
    for (std::size_t i = 0; i < batches.size(); ++i) {
      giveBackMemory();
      CellBatch<D> batch = cells_->load(batches[i], threads());
      MapScale<D> coarse = coarsen<D>(batch.cells, grid_, s);
      if (budget) cut(batch, coarse, s, cuts[i], *budget);
      coarser.add(coarse, coarserAreas(batch.cells, batch.areas, coarse.gaussianCount()));
      keepTiles(batch, &coarse, s);
    }
  }

  SpilledCuts keepCuts(const std::vector<CellKey<D>>& keys, const ScaleClusters& clusters) {
    std::vector<std::uint32_t> sizes;
    std::vector<Dendrogram::Merge> merges;
    std::vector<double> gains;
    for (std::size_t cell = 0; cell < keys.size(); ++cell) {
      const std::vector<Dendrogram::Merge>& own = clusters.dendrograms()[cell].merges;
      sizes.push_back(static_cast<std::uint32_t>(own.size()));
      merges.insert(merges.end(), own.begin(), own.end());
      gains.insert(gains.end(), clusters.gains()[cell].begin(), clusters.gains()[cell].end());
    }
    const auto keep = [&](const auto& values) {
      std::string bytes;
      putArray(bytes, values);
      return spill_.append(bytes);
    };
    return {keep(keys), keep(sizes), keep(merges), keep(gains)};
  }

  void cut(CellBatch<D>& batch, MapScale<D>& coarse, int s, const SpilledCuts& kept,
           const ScaleBudget<D>& budget) const {
    const auto sizes = arrayOf<std::uint32_t>(spill_, kept.sizes);
    const auto merges = arrayOf<Dendrogram::Merge>(spill_, kept.merges);
    std::vector<Dendrogram> dendrograms;
    auto next = merges.begin();
    for (const std::uint32_t size : sizes) {
      dendrograms.push_back({std::size_t{size} + 1, {next, next + size}});
      next += size;
    }
    const ScaleClusters clusters(std::move(dendrograms), threads());
    std::vector<std::size_t> parts;
    for (std::size_t cell = 0; cell < sizes.size(); ++cell)
      parts.push_back(budget.partsOf(coarse.keys[cell], clusters.gains()[cell]));
    setClusters(ScalePair<D>{batch.cells, coarse, grid_, s}, clusters.cut(parts), threads());
  }

  /// Compresses the tiles of a batch and stores them on disk. `coarse` holds the parent cells; nullptr at
  /// the coarsest scale.
  void keepTiles(const CellBatch<D>& batch, const MapScale<D>* coarse, int s) {
    const auto at = static_cast<std::size_t>(s);
    std::vector<TileRow<D>> rows(batch.tiles.size());
    std::vector<std::uint32_t> first_of_parent;  // per cell: index of the first Gaussian in its parent cell
    for (std::size_t cell = 0; coarse && cell < coarse->keys.size(); ++cell)
      first_of_parent.insert(first_of_parent.end(), coarse->first_child[cell + 1] - coarse->first_child[cell],
                             static_cast<std::uint32_t>(gaussiansOf(*coarse, cell).first));
    parallelFor(rows.size(), threads(), 1, [&](std::size_t i) {
      Tile<D> tile;
      for (std::size_t cell = i > 0 ? batch.tile_end[i - 1] : 0; cell < batch.tile_end[i]; ++cell) {
        const IndexRange range = gaussiansOf(batch.cells, cell);
        tile.keys.push_back(batch.cells.keys[cell]);
        tile.counts.push_back(static_cast<std::uint32_t>(range.size()));
        if (s == 0) tile.moments.push_back(batch.cells.moments[cell]);
        for (std::size_t j = range.first; j < range.last; ++j) {
          if (s > 0) tile.gaussians.push_back(batch.cells.gaussians[j]);
          if (coarse) tile.labels.push_back(batch.cells.parent[j] - first_of_parent[cell]);
        }
      }
      rows[i] = {s, batch.tiles[i], tile.keys.size(), tile.gaussianCount(),
                 encodeTile<D>(tile, {s, batch.tiles[i], span_}, grid_.options(), options_.save.compression)};
    });
    for (const TileRow<D>& row : rows) {
      cell_counts_[at] += row.cells;
      gaussian_counts_[at] += row.gaussians;
      tiles_[at].push_back({{s, row.tile, row.cells, row.gaussians, {}}, spill_.append(row.bytes)});
    }
  }

  const Grid<D> grid_;
  const BuildMapFileOptions& options_;
  const std::int32_t span_;
  const std::size_t batch_bytes_;
  SpillFile spill_;
  std::unique_ptr<SpilledCells<D>> cells_;  // cells of the current scale
  std::vector<std::size_t> cell_counts_, gaussian_counts_;
  std::vector<std::vector<SpilledTile<D>>> tiles_;  // by scale, in x, y, z order
};

}  // namespace

template <int D>
BuiltMapFile buildMapFile(const Scans& scans, const AccumulateOptions& reading, const MapOptions& map,
                          const std::filesystem::path& path,
                          const std::function<MapMetadata(const PointCounts&)>& metadataOf,
                          const BuildMapFileOptions& options,
                          const std::function<void(const AccumulateProgress&)>& progress) {
  require(options.max_memory >= kMinBuildMemory, "max_memory", static_cast<double>(options.max_memory),
          "must be at least " + std::to_string(kMinBuildMemory) + " bytes");
  if (options.refine.method != RefineMethod::Agglomerate)
    throw std::invalid_argument("method: only agglomeration works tile by tile");
  if (options.save.precision != Precision::Exact)
    throw std::invalid_argument("precision: must be exact; build first, then finish");
  if (reading.resolution != map.resolution)
    throw std::invalid_argument("resolution: must be the same for the scans and the map");
  if (!std::holds_alternative<PerCell>(options.budget) && !std::holds_alternative<MaxGaussians>(options.budget))
    throw std::invalid_argument("budget: MaxBytes and MaxError need the whole map; build first, then refine");
  if (options.refine.curves) throw std::invalid_argument("curves: need the whole map; build first, then refine");
  checkRefinement(options.budget, options.refine, Grid<D>(map).scales(), D);
  std::error_code error;
  if (!options.save.overwrite && std::filesystem::exists(path, error))
    throw FileError(path, "exists already and is not overwritten");
  AtomicFile file(path);
  const std::filesystem::path folder = file.target().has_parent_path() ? file.target().parent_path() : ".";
  Builder<D> builder(map, folder, options);
  const auto share = static_cast<std::size_t>(kShareOfSums * static_cast<double>(options.max_memory));
  BuiltMapFile built;
  built.counts = accumulateScansInParts<D>(
      scans, reading, share,
      [&](const MomentGrid<D>& moments) {
        giveBackMemory();  // memory of the previous moments
        builder.add(moments);
      },
      progress);
  const MapMetadata metadata = metadataOf(built.counts);
  giveBackMemory();
  builder.finishScales();
  {
    Database database(file.partPath(), Database::Mode::CreateForBulkWrite);
    builder.write(database, metadata);
  }
  file.commit();
  built.cells = builder.cellCounts();
  built.gaussians = builder.gaussianCounts();
  return built;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                \
  template BuiltMapFile buildMapFile<D>(                                                       \
      const Scans&, const AccumulateOptions&, const MapOptions&, const std::filesystem::path&, \
      const std::function<MapMetadata(const PointCounts&)>&, const BuildMapFileOptions&,       \
      const std::function<void(const AccumulateProgress&)>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
