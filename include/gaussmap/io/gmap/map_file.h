// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>
#include "gaussmap/editing/simplify.h"
#include "gaussmap/mapping/refine.h"

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

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

/// The name of the metadata that say how far a final map is from the one that it was made from.
inline constexpr const char* kFinalEntry = "final";

struct SaveOptions {
  bool overwrite = false;  ///< replace an existing file
  int compression = 3;     ///< zstd level
  int threads = 0;         ///< 0 = all; the bytes of the file do not depend on it
  Precision precision = Precision::Exact;
};

/// Writes the map whole or not at all: beside the target, then renamed over it. The same map gives the same bytes.
/// The file of a final map says so in its metadata, by the name kFinalEntry.
/// Throws FileError if the file exists and may not be replaced, or cannot be written; std::domain_error as finish().
template <int D>
GAUSSMAP_API void save(const std::filesystem::path& path, const GaussianMap<D>& map, const MapMetadata& metadata = {},
                       const SaveOptions& options = {});

/// How large the file would be that save() writes, to the byte [bytes]. Takes as much memory.
template <int D>
GAUSSMAP_API std::uintmax_t savedSize(const GaussianMap<D>& map, const MapMetadata& metadata = {},
                                      const SaveOptions& options = {});

/// A map for use, not for growth: about 10 bytes a Gaussian on the disk. Sums of points are dropped, numbers are
/// rounded to what the spread of a Gaussian allows, which is nowhere less than the noise floor:
/// - a mean by at most 1/16 standard deviation along each axis (that with the other coordinates fixed),
/// - the standard deviation in every direction by at most 5 %: covariances stay positive definite,
/// - a weight by at most 1/32 of it (up to 32 points not at all), log-odds by at most 1/32.
/// Scales finer than `finest_scale` are left out. Returns what load() gives back of the file that save() writes
/// with Precision::Finished; it cannot grow. Throws std::out_of_range for a scale that the map does not have,
/// std::domain_error for a Gaussian that is none.
template <int D>
GAUSSMAP_API GaussianMap<D> finish(const GaussianMap<D>& map, int finest_scale = 0);

/// What save() wrote, equal to it in every bit; a final map is that of finish(). Throws FileError, saying what is
/// wrong, if the file is no map, of a newer version, of another dimension, truncated or altered.
template <int D = 3>
GAUSSMAP_API GaussianMap<D> load(const std::filesystem::path& path);

/// The metadata given to save(). Throws FileError as load().
GAUSSMAP_API MapMetadata loadMetadata(const std::filesystem::path& path);

/// How large the parts of a map file are.
struct MapFileSize {
  std::uintmax_t file = 0;                  ///< [bytes]
  std::vector<std::uintmax_t> scale_tiles;  ///< compressed tiles of each scale, finest first [bytes]
};
GAUSSMAP_API MapFileSize mapFileSize(const std::filesystem::path& path);

// What the commands write beside a map, and `gaussmap info` shows. A refinement in C++:
//   const Budget budget = PerCell{4.0};
//   MapMetadata metadata = loadMetadata("in.gmap");
//   recordStep(metadata, refineStep(budget));
//   save("out.gmap", refine(load("in.gmap"), budget), metadata);

/// Metadata entry: a JSON array with one object per step, in the order in which they were done.
inline constexpr const char* kHistoryEntry = "history";
/// Metadata entry: JSON, [{"scale": s, "points": [{"gaussians": n, "q99": m, "q95": m, "mean": m}, ...]}, ...].
inline constexpr const char* kCurvesEntry = "error_curves";

/// The step of a refinement: method, budget, and what else differs from the defaults, as a JSON object. The members of
/// `details`, another JSON object such as {"command": "refine"}, are added and replace members of the same name. Throws
/// std::invalid_argument if `details` is not a JSON object.
GAUSSMAP_API std::string refineStep(const Budget& budget, const RefineOptions& options = {},
                                    const std::string& details = "{}");
/// The same for simplify().
GAUSSMAP_API std::string simplifyStep(const Budget& budget, const SimplifyOptions& options = {},
                                      const std::string& details = "{}");

/// Adds a step to the history. A history that is not a JSON array is replaced. Throws std::invalid_argument if `step`
/// is not a JSON object.
GAUSSMAP_API void recordStep(MapMetadata& metadata, const std::string& step);

/// Sets the error curves; removes old ones if there are none.
GAUSSMAP_API void recordCurves(MapMetadata& metadata, const std::vector<ErrorCurve>& curves);

/// save() and savedSize() with the curves of the result in the metadata.
template <int D>
GAUSSMAP_API void save(const std::filesystem::path& path, const RefineResult<D>& result, MapMetadata metadata = {},
                       const SaveOptions& options = {});
template <int D>
GAUSSMAP_API std::uintmax_t savedSize(const RefineResult<D>& result, MapMetadata metadata = {},
                                      const SaveOptions& options = {});

/// The budget of a map file of at most so many bytes, with curves and this metadata: measured by savedSize().
GAUSSMAP_API MaxBytes maxFileBytes(std::uintmax_t bytes, const MapMetadata& metadata = {},
                                   const SaveOptions& options = {});

}  // namespace gaussmap
