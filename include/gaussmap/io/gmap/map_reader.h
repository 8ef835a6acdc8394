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

/// Options of MapReader.
struct MapReaderOptions {
  std::size_t cache_bytes = std::size_t{256} << 20;  ///< maximum memory of cached tiles [bytes]; 0: no cache
  int threads = 0;                                   ///< 0 = all cores
};

/// Counts the work of a MapReader so far.
struct MapReaderStatistics {
  std::size_t tiles_read = 0;    ///< tiles read from the file and decoded
  std::size_t tiles_cached = 0;  ///< tiles found in the cache
  std::size_t cache_bytes = 0;   ///< current size of the cache
};

/// Reads a map file box by box.
///
/// Opening reads only the metadata. Loading a box reads the tiles that intersect it, from coarse to fine. Decoded tiles
/// stay in memory until the cache is full; the least recently used tiles are dropped first.
///
/// Writers can run at the same time, because save() and updateMap() replace a map file as a whole and never change it
/// in place. A reader keeps the file that it has opened, so all its data are of one version until refresh(). Several
/// threads can call load() and statistics(); they wait for each other. During refresh(), no other thread may use the
/// values of grid(), metadata(), cellCount() and gaussianCount().
template <int D>
class GAUSSMAP_API MapReader {
 public:
  /// Opens a map file. Throws FileError like the function gaussmap::load(), but only for problems that the metadata
  /// show. A damaged tile is detected when it is read.
  explicit MapReader(const std::filesystem::path& path, const MapReaderOptions& options = {});
  ~MapReader();
  MapReader(MapReader&&) noexcept;
  MapReader& operator=(MapReader&&) noexcept;

  /// Returns the path of the file.
  const std::filesystem::path& path() const;
  /// Returns the grid of the map. The reference is valid until refresh().
  const Grid<D>& grid() const;
  /// Returns the metadata given to save(). The reference is valid until refresh().
  const MapMetadata& metadata() const;
  /// Returns the number of cells of a scale of the whole file, from its metadata. Throws FileError if there is no such
  /// scale.
  std::size_t cellCount(int scale) const;
  /// Returns the number of Gaussians of a scale of the whole file, from its metadata.
  std::size_t gaussianCount(int scale) const;

  /// Returns the part of the map in a box [m, map frame]. The faces belong to the box, and the box can be infinite.
  ///
  /// The part holds the cells of `finest_scale` that intersect the box. Where compress() has deleted such cells, it
  /// holds the coarser leaf cells that intersect the box. It also holds all ancestors of these cells. Cells are never
  /// cut: every cell is bit-identical to the cell of the whole map and can extend beyond the box. Scales finer than
  /// `finest_scale` are empty. To show a place from coarse to fine, call `load(box, 2)`, `load(box, 1)`, `load(box)`;
  /// if the cache is large enough, each tile is read only once.
  ///
  /// Throws std::out_of_range if the map does not have the scale, std::invalid_argument if the box has low > high, and
  /// FileError if a tile is damaged.
  GaussianMap<D> load(const Box<D>& box, int finest_scale = 0);

  /// Reopens the path if the file has been replaced, and returns true if so. The cache is then empty, and grid() and
  /// metadata() can differ. Throws FileError, and keeps the old file, if the new file cannot be read.
  bool refresh();

  /// Returns the counts of the work so far.
  MapReaderStatistics statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gaussmap
