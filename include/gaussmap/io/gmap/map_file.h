// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

/// The .gmap file: an SQLite database with the tables `metadata` (name, value) and `tiles` (scale, x, y, z, cells,
/// gaussians, data). A tile is the block of cells of one scale whose keys share floor(key / span), span = the
/// smallest power of the ratio that is at least 32; `data` is a zstd frame with its own checksum, which holds the
/// cells as columns. PRAGMA application_id names the format, PRAGMA user_version its schema.
inline constexpr std::int32_t kMapFileId = 0x676D6170;  // "gmap"
inline constexpr int kMapFileVersion = 1;

/// Free text kept beside the map, by name: how it was made, where it lies.
using MapMetadata = std::map<std::string, std::string>;

/// How much of a map a file keeps.
enum class Precision {
  Exact,    ///< every bit
  Finished  ///< for use, not for growth: see finish()
};

/// The name of the metadata that say how far a finished map is from the one that it was made from.
inline constexpr const char* kFinalEntry = "final";

struct SaveOptions {
  bool overwrite = false;  ///< replace an existing file
  int compression = 3;     ///< zstd level
  int threads = 0;         ///< 0 = all; the bytes of the file do not depend on it
  Precision precision = Precision::Exact;
};

/// Writes the map whole or not at all: beside the target, then renamed over it. The same map gives the same bytes.
/// A finished file says so in its metadata, by the name kFinalEntry.
/// Throws FileError if the file exists and may not be replaced, or cannot be written; std::domain_error as finish().
template <int D>
void saveMap(const GaussianMap<D>& map, const std::filesystem::path& path, const MapMetadata& metadata = {},
             const SaveOptions& options = {});

/// How large the file would be that saveMap writes, to the byte [bytes]. Takes as much memory.
template <int D>
std::uintmax_t savedSize(const GaussianMap<D>& map, const MapMetadata& metadata = {}, const SaveOptions& options = {});

/// A map for use, not for growth: about 10 bytes a Gaussian on the disk. Sums of points are dropped, numbers are
/// rounded to what the spread of a Gaussian allows, which is nowhere less than the noise floor:
/// - a mean by at most 1/16 standard deviation along each axis (that with the other coordinates fixed),
/// - the standard deviation in every direction by at most 5 %: covariances stay positive definite,
/// - a weight by at most 1/32 of it (up to 32 points not at all), log-odds by at most 1/32.
/// Scales finer than `finest_scale` are left out. Returns what loadMap() gives back of the file that saveMap() writes
/// with Precision::Finished; it cannot grow. Throws std::out_of_range for a scale that the map does not have,
/// std::domain_error for a Gaussian that is none.
template <int D>
GaussianMap<D> finish(const GaussianMap<D>& map, int finest_scale = 0);

/// What saveMap wrote, equal to it in every bit; a finished map is that of finish(). Throws FileError, saying what is
/// wrong, if the file is no map, of a newer version, of another dimension, truncated or altered.
template <int D>
GaussianMap<D> loadMap(const std::filesystem::path& path);

/// The metadata given to saveMap. Throws FileError as loadMap.
MapMetadata loadMetadata(const std::filesystem::path& path);

/// How large the parts of a map file are.
struct MapFileSize {
  std::uintmax_t file = 0;                  ///< [bytes]
  std::vector<std::uintmax_t> scale_tiles;  ///< compressed tiles of each scale, finest first [bytes]
};
MapFileSize mapFileSize(const std::filesystem::path& path);

}  // namespace gaussmap
