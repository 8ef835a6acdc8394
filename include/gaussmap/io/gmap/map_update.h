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
  /// Maximum number of Gaussians per cell of a coarse scale, on average, >= 1; std::nullopt: the present average of the
  /// scale. A scale can exceed it: unchanged cells keep their Gaussians, and each rebuilt cell gets at least one.
  std::optional<double> budget;
  MergeCost merge_cost = MergeCost::Volume;     ///< as in RefineOptions
  int compression = SaveOptions().compression;  ///< zstd level of changed tiles
  int threads = 0;                              ///< 0 = all cores
};

/// Two scans with at least this many points in a cell almost never have the same exact sums there, see MapUpdate.
inline constexpr std::int64_t kDensePoints = 3;

/// The result of updateMap().
struct MapUpdate {
  std::vector<std::size_t> cells;      ///< cells of the whole map after the update, per scale, finest first
  std::vector<std::size_t> gaussians;  ///< the same for Gaussians
  std::size_t tiles_written = 0;       ///< number of changed tiles; the others keep their bytes
  std::size_t tiles = 0;               ///< number of tiles in the file
  std::size_t cells_added_to = 0;      ///< finest cells with new points
  /// Of these, the cells whose exact sums before the update were those of the new points, or a whole multiple. Many
  /// such cells mean that a scan was added twice.
  std::size_t cells_repeated = 0;
  std::size_t dense_cells = 0;           ///< finest cells with at least kDensePoints new points each
  std::size_t dense_cells_repeated = 0;  ///< of these, the cells with such sums
};

/// Adds points to a map file. It decodes only the tiles that hold a coarsest cell with new points or cells below it. It
/// encodes only the tiles that change.
///
/// The finest scale is bit-identical to that of a map built from all points. Coarse cells with new points below them
/// are rebuilt; all other cells stay unchanged. The unchanged cells keep their part of the scale's budget, and the
/// rebuilt cells share the rest. So the coarse scales can differ from those of a map built from all points. They are
/// identical if the map has one Gaussian per cell and keeps this budget (1). Otherwise, load the updated map and call
/// refine(): the result is identical to that of refine() for a map built from all points.
///
/// In a map with occupancy, finest cells keep their log-odds, and new cells get kMaxOccupancy. No log-odds of a finest
/// cell are lowered, because points alone do not show that something else is gone. The log-odds of a rebuilt coarse
/// cluster are the maximum over its children.
///
/// The update is atomic: readers see either the old or the new file, also after a crash. The file is copied, changed
/// and renamed, so the disk holds both for a short time. While one writer runs, any other writer throws FileError.
/// `edit`, if given, receives the metadata once given to save() and can change them. Throws FileError if the file
/// cannot be read or written, or if the map accepts no more points (see GaussianMap::acceptsScans()). Throws
/// std::invalid_argument if the resolution of `added` differs from that of the map, or if the budget is below 1.
template <int D>
GAUSSMAP_API MapUpdate updateMap(const std::filesystem::path& path, const MomentGrid<D>& added,
                                 const UpdateOptions& options = {}, const std::function<void(MapMetadata&)>& edit = {});

/// Returns the options of a map file, if points can be added to it. The MomentGrid for updateMap() must have the same
/// resolution. Throws FileError if the file is not a map, or if the map accepts no more points.
template <int D>
GAUSSMAP_API MapOptions growingMapOptions(const std::filesystem::path& path);

}  // namespace gaussmap
