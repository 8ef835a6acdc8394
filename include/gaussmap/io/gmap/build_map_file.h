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
  Budget budget = PerCell{};  ///< PerCell or MaxGaussians
  RefineOptions refine;       ///< agglomeration without curves; its `threads` applies to the whole build
  SaveOptions save;           ///< of the file, with Precision::Exact
};

/// The result of buildMapFile().
struct BuiltMapFile {
  PointCounts counts;  ///< accepted and dropped points
  /// Number of cells per scale, finest first.
  std::vector<std::size_t> cells, gaussians;  ///< number of Gaussians per scale, finest first
};

/// Builds a map file from scans in limited memory, for maps that do not fit into memory.
///
/// The file is bit-identical to the file that save() writes of refine(build(accumulateScans())) with the same options
/// and metadata.
///
/// When the sums of points reach their share of the memory, they are written by tile to an anonymous temporary file in
/// the folder of the map. The scales are built from fine to coarse: batches of tiles are read back, refined and
/// compressed. The budget applies to all clusters of a scale at once. The dendrograms therefore wait in the temporary
/// file, and a few passes over the gains of their merges find the smallest gain that is used. One tile must always fit
/// into memory: it has at least 32 cells along a side, of which only occupied cells need memory.
///
/// `metadataOf(counts)` returns the metadata of the map. Throws like accumulateScans(), save() and refine(). Also
/// throws std::invalid_argument for RefineMethod::Insert, which needs all cells at once, and for too little memory.
GAUSSMAP_API BuiltMapFile buildMapFile(const Scans& scans, const AccumulateOptions& reading, const MapOptions& map,
                                       const std::filesystem::path& path,
                                       const std::function<MapMetadata(const PointCounts&)>& metadataOf,
                                       const BuildMapFileOptions& options,
                                       const std::function<void(const AccumulateProgress&)>& progress = {});

}  // namespace gaussmap
