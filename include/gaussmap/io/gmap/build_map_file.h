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

inline constexpr std::size_t kMinBuildMemory = std::size_t{1} << 20;

struct BuildMapFileOptions {
  std::size_t max_memory = std::size_t{1} << 30;  ///< about so much is used beside the scans that are read and what the
                                                  ///< program takes anyhow, >= kMinBuildMemory [bytes]
  Budget budget = PerCell{};                      ///< or MaxGaussians
  RefineOptions refine;  ///< by agglomeration, without curves; its threads are those of the whole build
  SaveOptions save;
};

struct BuiltMapFile {
  PointCounts counts;
  std::vector<std::size_t> cells, gaussians;  ///< by scale, finest first
};

/// Scans -> map file, for maps that do not fit into memory: the file has the same bytes as that which save() writes
/// of refine(build(accumulateScans())) with the same options and metadata.
///
/// Sums of points that fill their share of the memory are written, by tile, to a file without a name in the folder of
/// the map. Scale by scale, from the finest up, tiles are read back one batch after the other, refined, and
/// compressed. Which clusters of a scale the budget allows is found in all of them at once without holding them: their
/// dendrograms wait in that file, and a few walks over the gains of their merges find the least one that is taken. What
/// is not bounded is one tile: at least 32 cells along a side (tileSpan()), in which only occupied cells count.
///
/// `metadataOf(counts)` = the metadata of the map. Throws as accumulateScans(), save() and refine();
/// std::invalid_argument for RefineMethod::Insert, which looks at all cells at once, and for too little memory.
GAUSSMAP_API BuiltMapFile buildMapFile(const Scans& scans, const AccumulateOptions& reading, const MapOptions& map,
                                       const std::filesystem::path& path,
                                       const std::function<MapMetadata(const PointCounts&)>& metadataOf,
                                       const BuildMapFileOptions& options,
                                       const std::function<void(const AccumulateProgress&)>& progress = {});

}  // namespace gaussmap
