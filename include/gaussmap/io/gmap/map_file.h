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

/// The application id of a .gmap file ("gmap"), stored as PRAGMA application_id.
///
/// A .gmap file is an SQLite database with the tables `metadata` (name, value) and `tiles` (scale, x, y, z, cells,
/// gaussians, data). A tile is a block of cells of one scale, with `span` cells along each side. It holds the cells
/// with the same value of floor(key / span), which is x, y, z of the tile. The span is the smallest power of the ratio
/// that is at least 32. `data` is a zstd frame with its own checksum. It stores the cells as columns: one number of all
/// cells after the other.
inline constexpr std::int32_t kMapFileId = 0x676D6170;  // "gmap"
/// The version of the schema of a .gmap file, stored as PRAGMA user_version.
inline constexpr int kMapFileVersion = 1;

/// Free text that is stored with the map, by name: for example how the map was made and which place it shows.
using MapMetadata = std::map<std::string, std::string>;

/// How exactly a file stores the map.
enum class Precision {
  Exact,    ///< all bits of the map are kept
  Finished  ///< the numbers are rounded: a final map, see finish()
};

/// Name of the metadata entry that states the precision of a final map.
inline constexpr const char* kFinalEntry = "final";

/// Options of save() and savedSize().
struct SaveOptions {
  bool overwrite = false;                  ///< replaces an existing file
  int compression = 3;                     ///< zstd level
  int threads = 0;                         ///< 0 = all cores
  Precision precision = Precision::Exact;  ///< how exactly the map is stored
};

/// Writes a map to a .gmap file. The same map gives the same bytes.
///
/// The write is atomic: readers see either the old or the new file, also after a crash. A final map is marked by the
/// metadata entry kFinalEntry. Throws FileError if the file exists and `overwrite` is not set, or if the file cannot be
/// written. For Precision::Finished, it throws std::domain_error like finish().
template <int D>
GAUSSMAP_API void save(const std::filesystem::path& path, const GaussianMap<D>& map, const MapMetadata& metadata = {},
                       const SaveOptions& options = {});

/// Returns the exact size of the file that save() would write [bytes]. The function builds the file in memory.
template <int D>
GAUSSMAP_API std::uintmax_t savedSize(const GaussianMap<D>& map, const MapMetadata& metadata = {},
                                      const SaveOptions& options = {});

/// Returns the final form of a map: it takes about 10 bytes per Gaussian on disk, but accepts no more scans.
///
/// The sums of points are dropped, and the numbers are rounded:
/// - Along each axis, a mean changes by at most 1/16 of the standard deviation that the Gaussian has along this axis if
///   its other coordinates are fixed.
/// - The standard deviation in any direction changes by at most 5 %, and covariances stay positive definite.
/// - A weight changes by at most 1/32 of its value (weights up to 32 are exact), log-odds by at most 1/32.
///
/// After the rounding, a standard deviation can be up to 5 % below the noise floor. Scales finer than `finest_scale`
/// are left empty. For `finest_scale` = 0, the result is what load() returns for a file saved with Precision::Finished.
/// Throws std::out_of_range if the map does not have the scale, and std::domain_error if a covariance is not positive
/// definite or a weight is not positive.
template <int D>
GAUSSMAP_API GaussianMap<D> finish(const GaussianMap<D>& map, int finest_scale = 0);

/// Reads a map from a .gmap file. The map is bit-identical to the saved one, or to the result of finish() if it was
/// saved with Precision::Finished.
///
/// Throws FileError if the file is not a map, has a newer version or another dimension, or is truncated or altered; the
/// message gives the reason.
template <int D = 3>
GAUSSMAP_API GaussianMap<D> load(const std::filesystem::path& path);

/// Returns the number of dimensions of the map in a file: 2 or 3. Read a planar map with load<2>(), and a map in space
/// with load(). Throws FileError if the file is not a map, has a newer version, or gives any other number.
GAUSSMAP_API int mapDimensions(const std::filesystem::path& path);

/// Returns the metadata given to save(). Throws FileError if the file is not a map, like load().
GAUSSMAP_API MapMetadata loadMetadata(const std::filesystem::path& path);

/// The sizes of the parts of a map file.
struct MapFileSize {
  std::uintmax_t file = 0;                  ///< whole file [bytes]
  std::vector<std::uintmax_t> scale_tiles;  ///< compressed tiles per scale, finest first [bytes]
};
/// Returns the sizes of the parts of a map file. Throws FileError if the file is not a map.
GAUSSMAP_API MapFileSize mapFileSize(const std::filesystem::path& path);

// The entries below record how a map was made. The commands write them, and `gaussmap info` shows them. Example in C++:
//   const Budget budget = PerCell{4.0};
//   MapMetadata metadata = loadMetadata("in.gmap");
//   recordStep(metadata, refineStep(budget));
//   save("out.gmap", refine(load("in.gmap"), budget), metadata);

/// Name of the metadata entry with the history: a JSON array with one object per step, in the order of the steps.
inline constexpr const char* kHistoryEntry = "history";
/// Name of the metadata entry with the error curves, as JSON. n is a number of Gaussians, m is a distance [m]:
/// `[{"scale": s, "points": [{"gaussians": n, "q99": m, "q95": m, "mean": m}, ...]}, ...]`.
inline constexpr const char* kCurvesEntry = "error_curves";

/// Name of the metadata entry with the coordinate reference system of the map frame, as text (often WKT), if the scans
/// had one.
inline constexpr const char* kCoordinateSystemEntry = "coordinate_system";

/// Returns the history step of a refinement as a JSON object: the method, the budget, the options that change the map
/// and differ from their defaults, and the seed if the method is RefineMethod::Insert.
///
/// The members of `details`, another JSON object such as `{"command": "refine"}`, are added and replace members of the
/// same name. Throws std::invalid_argument if `details` is not a JSON object.
GAUSSMAP_API std::string refineStep(const Budget& budget, const RefineOptions& options = {},
                                    const std::string& details = "{}");
/// Returns the history step of a simplification as a JSON object. It works like refineStep().
GAUSSMAP_API std::string simplifyStep(const Budget& budget, const SimplifyOptions& options = {},
                                      const std::string& details = "{}");

/// Appends a step to the history. A history that is not a JSON array is replaced. Throws std::invalid_argument if
/// `step` is not a JSON object.
GAUSSMAP_API void recordStep(MapMetadata& metadata, const std::string& step);

/// Stores the error curves in the metadata, or removes old curves if `curves` is empty.
GAUSSMAP_API void recordCurves(MapMetadata& metadata, const std::vector<ErrorCurve>& curves);

/// Writes the map of a result to a .gmap file, with the curves of the result in the metadata. Throws like the other
/// save().
template <int D>
GAUSSMAP_API void save(const std::filesystem::path& path, const RefineResult<D>& result, MapMetadata metadata = {},
                       const SaveOptions& options = {});
/// Returns the exact size of the file that save() would write of a result [bytes].
template <int D>
GAUSSMAP_API std::uintmax_t savedSize(const RefineResult<D>& result, MapMetadata metadata = {},
                                      const SaveOptions& options = {});

/// Returns a budget that limits a map file to `bytes` bytes. The file is written with these options and this metadata,
/// and with the error curves. Its size is computed with savedSize().
GAUSSMAP_API MaxBytes maxFileBytes(std::uintmax_t bytes, const MapMetadata& metadata = {},
                                   const SaveOptions& options = {});

}  // namespace gaussmap
