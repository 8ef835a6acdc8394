// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "io/files/spill_file.h"

namespace gaussmap::detail {

/// The cells of some tiles of one scale in memory: tile after tile, in key order within each tile.
template <int D>
struct CellBatch {
  MapScale<D> cells;
  std::vector<double> areas;          ///< per Gaussian: number of occupied finest cells that it represents
  std::vector<CellKey<D>> tiles;      ///< in x, y, z order
  std::vector<std::size_t> tile_end;  ///< index behind the last cell of each tile
};

/// The cells of one scale, stored on disk by tile.
template <int D>
class SpilledCells {
 public:
  SpilledCells(SpillFile& file, const MapOptions& options, int scale);

  /// Adds moments to the cells of the finest scale.
  void add(const MomentGrid<D>& moments);
  /// Adds cells of a coarser scale. None of them may have been added before.
  void add(const MapScale<D>& cells, const std::vector<double>& areas);

  /// Returns all tiles, in x, y, z order, in batches of at most `bytes` bytes. A larger tile is a batch of its own.
  std::vector<std::vector<CellKey<D>>> batches(std::size_t bytes) const;
  /// Reads some tiles. Moments that were added in several pieces are written back as one piece, for the next read.
  CellBatch<D> load(const std::vector<CellKey<D>>& tiles, int threads);

 private:
  SpillFile& file_;
  MapOptions options_;
  int scale_;
  std::map<CellKey<D>, std::vector<SpillFile::Span>> pieces_;
};

}  // namespace gaussmap::detail
