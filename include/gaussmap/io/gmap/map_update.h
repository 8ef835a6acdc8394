// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct UpdateOptions {
  std::optional<double> budget;                 ///< Gaussians of a coarse scale, as a multiple of its cells, >= 1;
                                                ///< nothing: as many for a cell as the scale has now
  MergeCost merge_cost = MergeCost::Volume;     ///< as RefineOptions
  int compression = SaveOptions().compression;  ///< zstd level of the tiles that change
  int threads = 0;                              ///< 0 = all; the bytes of the file do not depend on it
};

struct MapUpdate {
  std::vector<std::size_t> cells, gaussians;  ///< of the whole map now, by scale, finest first
  std::size_t tiles_written = 0;              ///< the others keep their bytes
  std::size_t tiles = 0;                      ///< in the file
};

/// Adds points to a map file, reading only what lies under the coarsest cells that they fall into, writing only the
/// tiles that change. The finest scale is that of a map built of all points at once, to the last bit. Coarse cells with
/// new points under them are made anew; they share the Gaussians that the budget of the whole scale leaves beside the
/// cells that stay as they are. A build at once shares all of them among all cells: with one Gaussian a cell (budget 1)
/// the coarse scales are the same too, with more refine() makes them so.
///
/// Cells of a map with occupancy keep theirs, new ones are certain (kMaxOccupancy): points are no evidence that
/// something else has gone; coarse Gaussians are as occupied as what is most so under them.
///
/// The file is copied beside itself, changed there, and renamed: whoever reads, and whatever interrupts, there is the
/// old map or the new one. It takes the place of both on the disk for that time. One writer at a time.
/// `edit` may change the metadata given to save(). Throws FileError if the file cannot be read or written, or takes
/// no more points (GaussianMap::acceptsScans()), std::invalid_argument if the cells of the grid are not those of the
/// map or the budget is below 1.
template <int D>
GAUSSMAP_API MapUpdate updateMap(const std::filesystem::path& path, const MomentGrid<D>& added,
                                 const UpdateOptions& options = {}, const std::function<void(MapMetadata&)>& edit = {});

/// The options of a map file: what points must be counted by that shall be added to it. Throws FileError as load(),
/// and if the map takes no more points.
template <int D>
GAUSSMAP_API MapOptions growingMapOptions(const std::filesystem::path& path);

}  // namespace gaussmap
