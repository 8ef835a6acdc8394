// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The index of a directory of tiles.
inline constexpr const char* kTilesIndex = "pointcloud_map_metadata.yaml";

struct TilesOptions {
  int size = 20;                 ///< side of a tile [m], whole, because the index holds whole numbers; >= 1
  std::optional<int> scale = 0;  ///< the scale that is written; nothing: all
};

struct WrittenTiles {
  std::size_t tiles = 0;
  std::size_t gaussians = 0;
};

/// Writes Gaussians as PCD files by squares of the ground, in the layout that Autoware's pointcloud_map_loader reads
/// for dynamic map loading: `x_resolution`, `y_resolution` and a line `tile_X_Y.pcd: [X, Y]` for each file with its
/// lower corner. A Gaussian belongs to the square that its mean lies in. The files have the fields of savePcd(),
/// means in the map frame as floats, so that their x, y, z are a point cloud map; a comment in the index keeps the
/// options of the map. The directory appears whole or not at all. Throws FileError if it is there already (unless it is
/// empty) or cannot be written, std::out_of_range for a scale that the map does not have or a map beyond 2^31 m,
/// std::invalid_argument for a size below 1.
GAUSSMAP_API WrittenTiles saveTiles(const std::filesystem::path& folder, const GaussianMap<3>& map,
                                    const TilesOptions& options = {});

/// The map that such a directory holds: the scales that were written, but from the finest scale alone the coarser ones
/// are made anew, one Gaussian a cell, if the index tells the options. Throws FileError, naming index or tile.
GAUSSMAP_API GaussianMap<3> loadTiles(const std::filesystem::path& folder);

}  // namespace gaussmap
