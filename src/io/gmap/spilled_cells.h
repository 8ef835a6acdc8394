// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "io/files/spill_file.h"

namespace gaussmap::detail {

/// Cells of one scale in memory: those of some tiles, one tile after the other, each in key order.
struct CellBatch {
  MapScale<3> cells;
  std::vector<double> areas;          ///< per Gaussian, occupied finest cells that it stands for
  std::vector<CellKey<3>> tiles;      ///< in x, y, z order
  std::vector<std::size_t> tile_end;  ///< index behind the last cell of each tile
};

/// The cells of one scale, by tile, most of them on the disk.
class SpilledCells {
 public:
  SpilledCells(SpillFile& file, const MapOptions& options, int scale);

  /// Adds sums to the cells of the finest scale.
  void add(const MomentGrid<3>& moments);
  /// Adds cells of a coarser scale, none of which is here yet.
  void add(const MapScale<3>& cells, const std::vector<double>& areas);

  /// All tiles, in x, y, z order, in batches of about so many bytes or of one tile.
  std::vector<std::vector<CellKey<3>>> batches(std::size_t bytes) const;
  /// Reads some tiles; sums that were added bit by bit are written back as one, for the next time.
  CellBatch load(const std::vector<CellKey<3>>& tiles, int threads);

 private:
  SpillFile& file_;
  MapOptions options_;
  int scale_;
  std::map<CellKey<3>, std::vector<SpillFile::Span>> pieces_;
};

}  // namespace gaussmap::detail
