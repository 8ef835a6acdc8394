// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The name of the index file in a folder of tiles.
inline constexpr const char* kTilesIndex = "pointcloud_map_metadata.yaml";

/// Options of saveTiles().
struct TilesOptions {
  int size = 20;                 ///< side of a tile [m], >= 1; an integer because the index holds integers
  std::optional<int> scale = 0;  ///< the scale to write; std::nullopt: all scales
  bool floats = false;           ///< writes x, y, z as floats, even if this rounds them, see saveTiles()
};

/// The result of saveTiles().
struct WrittenTiles {
  std::size_t tiles = 0;      ///< number of files
  std::size_t gaussians = 0;  ///< number of Gaussians in all files
  bool doubles = false;       ///< x, y, z are doubles
  double rounding = 0.0;      ///< rounding error of floats at the farthest Gaussian [m]
};

/// Writes a map as a folder of PCD files, one per tile (a square of the ground). A program can then load only the tiles
/// near the robot.
///
/// The layout is that of Autoware's pointcloud_map_loader. The index gives the side of the tiles as `x_resolution` and
/// `y_resolution`. It has one line `tile_X_Y.pcd: [X, Y]` per file, where X and Y are the lower corner of the tile [m].
/// A Gaussian belongs to the tile that contains its mean. The files have the fields of savePcd(), with means in the map
/// frame, so other programs can read x, y, z as a point cloud map. A comment in the index stores the options of the
/// map.
///
/// The means are floats, which PCL's point types and Autoware need. If floats would lose a thousandth of a finest cell
/// far from the origin, they are doubles. TilesOptions::floats writes floats anyway; if their steps exceed a cell, the
/// tiles cannot be read as a map again.
///
/// The write is atomic: the folder appears only when it is complete. Throws FileError if the folder exists and is not
/// empty, or cannot be written. Throws std::out_of_range if the map does not have the scale or reaches beyond 2^31 m,
/// and std::invalid_argument if the size is below 1.
GAUSSMAP_API WrittenTiles saveTiles(const std::filesystem::path& folder, const GaussianMap<3>& map,
                                    const TilesOptions& options = {});

/// Reads the map from a folder of tiles. The map has the scales that were written.
///
/// There is one exception: the coarser scales are rebuilt, with one Gaussian per cell, if the index stores the options
/// and the tiles hold only the finest scale, with one Gaussian per cell and without occupancy. Throws FileError if a
/// file is not valid; the message gives the index or the tile.
GAUSSMAP_API GaussianMap<3> loadTiles(const std::filesystem::path& folder);

}  // namespace gaussmap
