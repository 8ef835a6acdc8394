// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/grid.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct MapReaderOptions {
  std::size_t cache_bytes = std::size_t{256} << 20;  ///< most memory of decoded tiles that are kept; 0: none is
  int threads = 0;                                   ///< 0 = all
};

/// What a reader did so far.
struct MapReaderStatistics {
  std::size_t tiles_read = 0;    ///< from the file, decoded
  std::size_t tiles_cached = 0;  ///< found in the cache instead
  std::size_t cache_bytes = 0;   ///< decoded tiles in the cache now
};

/// A map file that is loaded box by box: opening reads the metadata and no tile, a box reads the tiles that it meets,
/// coarsest scale first. Decoded tiles stay in memory, the least recently used go first.
///
/// Safe beside writers: map files are never changed where they are, only replaced as a whole (save(), updateMap()).
/// A reader keeps the file that it opened, so that all it loads is of one version, until refresh() takes the new one.
/// Calls from several threads are safe and wait for each other.
template <int D>
class GAUSSMAP_API MapReader {
 public:
  /// Throws FileError as load(), as far as the metadata tell; what is wrong with a tile is found when it is read.
  explicit MapReader(const std::filesystem::path& path, const MapReaderOptions& options = {});
  ~MapReader();
  MapReader(MapReader&&) noexcept;
  MapReader& operator=(MapReader&&) noexcept;

  const std::filesystem::path& path() const;
  /// Where its cells are. Like metadata(), a reference that refresh() ends.
  const Grid<D>& grid() const;
  /// What was given to save().
  const MapMetadata& metadata() const;
  /// Cells and Gaussians of a scale of the whole file, as its metadata tell.
  std::size_t cellCount(int scale) const;
  std::size_t gaussianCount(int scale) const;

  /// The part of the map in a box [m, map frame], faces included, infinite ones too: the cells of `finest_scale` that
  /// meet it, where a compressed map has nothing so fine the coarser cells that stand there, and all cells above
  /// these. Every cell is as it is in the whole map, to the last bit: coarse cells reach beyond the box. Scales finer
  /// than `finest_scale` are empty. load(box, 2), load(box, 1), load(box) show a place from coarse to fine and
  /// read each tile once. Throws std::out_of_range for a scale that the map does not have, std::invalid_argument for a
  /// box that is none, FileError for damaged tiles.
  GaussianMap<D> load(const Box<D>& box, int finest_scale = 0);

  /// Goes over to the file that has the path now. False if it is still the same one; else the cache is empty, and the
  /// options of the map may be others. Throws FileError, and keeps the old file, if the new one cannot be read.
  bool refresh();

  MapReaderStatistics statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gaussmap
