// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Minimum of BuildMapFileOptions::max_memory [bytes].
inline constexpr std::size_t kMinBuildMemory = std::size_t{1} << 20;

/// Options of buildMapFile().
struct BuildMapFileOptions {
  /// Approximate memory limit [bytes], >= kMinBuildMemory. The scans being read and the memory of the program itself
  /// are not included.
  std::size_t max_memory = std::size_t{1} << 30;
  Budget budget = PerCell{};  ///< must be PerCell or MaxGaussians
  RefineOptions refine;       ///< must be RefineMethod::Agglomerate without curves; `threads` is for the whole build
  SaveOptions save;           ///< must be Precision::Exact; `threads` is not used
};

/// The result of buildMapFile().
struct BuiltMapFile {
  PointCounts counts;  ///< accepted and dropped points
  /// Number of cells per scale, finest first.
  std::vector<std::size_t> cells, gaussians;  ///< number of Gaussians per scale, finest first
};

/// Builds a map file from scans in limited memory, for maps that do not fit into memory.
///
/// The file is bit-identical to the result of accumulateScans(), build(), refine() and save() with the same options and
/// metadata. For D = 2, the file holds a planar map.
///
/// While scans are read, each thread writes its sums of points to a temporary file whenever they fill its share of the
/// memory, and at the end. The file has no name and lies in the folder of the map; its data are grouped by tile. The
/// scales are built from fine to coarse: batches of tiles are read back, refined and compressed. Only one batch is in
/// memory, but the budget applies to the whole scale. The merges of all batches are therefore kept in the temporary
/// file, and a few passes over their gains decide which of them are undone (see refine()). Tiles are never split, so
/// memory exceeds the limit if a single tile is too large. A tile has at least 32 cells along a side, of which only
/// occupied cells need memory.
///
/// `metadataOf(counts)` returns the metadata of the map. Throws like accumulateScans(), save() and refine(). Also
/// throws std::invalid_argument if `max_memory` is too small, if the resolutions of `reading` and `map` differ, or if
/// an option needs the whole map at once: RefineMethod::Insert, curves, MaxBytes, MaxError or Precision::Finished.
template <int D = 3>
GAUSSMAP_API BuiltMapFile buildMapFile(const Scans& scans, const AccumulateOptions& reading, const MapOptions& map,
                                       const std::filesystem::path& path,
                                       const std::function<MapMetadata(const PointCounts&)>& metadataOf,
                                       const BuildMapFileOptions& options,
                                       const std::function<void(const AccumulateProgress&)>& progress = {});

}  // namespace gaussmap
