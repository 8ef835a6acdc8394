// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of updateMap().
struct UpdateOptions {
  /// Maximum number of Gaussians of a coarse scale, as a multiple of its cells, >= 1; std::nullopt: the present
  /// multiple of the scale.
  std::optional<double> budget;
  MergeCost merge_cost = MergeCost::Volume;     ///< as in RefineOptions
  int compression = SaveOptions().compression;  ///< zstd level of changed tiles
  int threads = 0;                              ///< 0 = all cores
};

/// So many points of two different scans nearly never have the same exact sums in a cell, see MapUpdate.
inline constexpr std::int64_t kDensePoints = 3;

/// The result of updateMap().
struct MapUpdate {
  /// Number of cells of the whole map after the update, per scale, finest first.
  std::vector<std::size_t> cells, gaussians;  ///< number of Gaussians of the whole map, per scale, finest first
  std::size_t tiles_written = 0;              ///< number of changed tiles; the others keep their bytes
  std::size_t tiles = 0;                      ///< number of tiles in the file
  std::size_t cells_added_to = 0;             ///< finest cells with new points
  /// Of these, the cells that held exactly the new points before: their exact sums are equal, or a whole multiple. Many
  /// such cells mean that a scan is added again.
  std::size_t cells_repeated = 0;
  std::size_t dense_cells = 0;           ///< finest cells with at least kDensePoints new points each
  std::size_t dense_cells_repeated = 0;  ///< of these, the cells that held exactly the new points before
};

/// Adds points to a map file. It reads only the tiles below the coarsest cells with new points and writes only the
/// tiles that change.
///
/// The finest scale is bit-identical to that of a map built from all points. Coarse cells with new points below them
/// are rebuilt; all other cells stay unchanged. The rebuilt cells share the part of the scale's budget that the
/// unchanged cells leave. A map built from all points shares the whole budget among all cells. With one Gaussian per
/// cell (budget 1) the coarse scales are therefore identical; with a larger budget, refine() makes them identical.
///
/// In a map with occupancy, finest cells keep their log-odds, and new cells get kMaxOccupancy. New points are no
/// evidence that something else is gone. The log-odds of a rebuilt coarse cluster are the maximum over its children.
///
/// The update is atomic: readers see either the old or the new file, also after a crash. The file is copied, changed
/// and renamed, so the disk holds both for a short time. Only one writer can run at a time. `edit` can change the
/// metadata given to save(). Throws FileError if the file cannot be read or written, or if the map accepts no more
/// points (see GaussianMap::acceptsScans()). Throws std::invalid_argument if the cells of `added` differ from those of
/// the map, or if the budget is below 1.
template <int D>
GAUSSMAP_API MapUpdate updateMap(const std::filesystem::path& path, const MomentGrid<D>& added,
                                 const UpdateOptions& options = {}, const std::function<void(MapMetadata&)>& edit = {});

/// Returns the options of a map file to which points can be added. Count the points in cells of this resolution. Throws
/// FileError if the file is not a map, or if the map accepts no more points.
template <int D>
GAUSSMAP_API MapOptions growingMapOptions(const std::filesystem::path& path);

}  // namespace gaussmap
