// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// One Gaussian as stored in a PCD file and in PCL's PointGaussian. Both store the mean as floats.
struct GaussianRecord {
  std::array<double, 3> mean;        ///< x y z [m], relative to GaussianRecords::origin
  std::array<float, 6> covariance;   ///< xx xy xz yy yz zz [m^2]
  float weight;                      ///< number of points
  float occupancy;                   ///< log-odds; kMaxOccupancy if the map has no occupancy
  float cell_side;                   ///< side of its cell [m]
  float scale;                       ///< 0 = finest; a float because pcl::PassThrough filters only floats
  std::array<std::int32_t, 3> cell;  ///< key of its cell
};

/// The Gaussians of a map as records.
struct GAUSSMAP_API GaussianRecords {
  std::vector<GaussianRecord> records;  ///< one per Gaussian, in any order
  /// Offset to add to the means [m]. It is zero if floats resolve a thousandth of a finest cell everywhere in the map.
  /// Otherwise its coordinates are multiples of 1024 m, which a float holds exactly. The file stores it as VIEWPOINT.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// Converts the Gaussians of all scales, or of one scale, to records. The coarsest scale is first, and each scale keeps
/// its order. Throws std::out_of_range if the map does not have the scale.
GAUSSMAP_API GaussianRecords toRecords(const GaussianMap<3>& map, std::optional<int> scale = std::nullopt);

/// Converts the Gaussians of a planar map to records: all means have z = 0, and the standard deviation across the plane
/// is MapOptions::noise.
GAUSSMAP_API GaussianRecords toRecords(const GaussianMap<2>& map, std::optional<int> scale = std::nullopt);

/// Converts records to a map.
///
/// The grid follows from cell sides and scales. The parent of a finer Gaussian is the nearest cluster of the coarser
/// cell under the KL divergence. If rounding to floats has made a covariance indefinite, its eigenvalues are raised to
/// at least 1e-6 of the largest. Coarse cells without finer cells give a compressed map. A single scale becomes the
/// finest scale of a map with one scale. Throws std::invalid_argument if the records do not form a map; the message
/// gives the reason.
GAUSSMAP_API GaussianMap<3> fromRecords(const GaussianRecords& records);

/// Writes records to a PCD file with the fields of savePcd(). Throws FileError if the file cannot be written.
GAUSSMAP_API void saveRecordsPcd(const std::filesystem::path& path, const GaussianRecords& records);
/// Reads records from a PCD file with the fields of savePcd(). x y z can be doubles. Throws FileError if the file is
/// not such a cloud.
GAUSSMAP_API GaussianRecords loadRecordsPcd(const std::filesystem::path& path);

/// Options of savePcd().
struct ExportOptions {
  std::optional<int> scale;  ///< the scale to write; std::nullopt: all scales
  bool overwrite = false;    ///< replaces an existing file
};

/// Writes a map, or one scale, to a PCD file that PCL and its tools can read.
///
/// The fields are x y z covariance[6] weight occupancy cell_side scale cell_x cell_y cell_z. Throws FileError if the
/// file exists and `overwrite` is not set, or if the file cannot be written.
GAUSSMAP_API void savePcd(const std::filesystem::path& path, const GaussianMap<3>& map,
                          const ExportOptions& options = {});
/// Writes a planar map like a map in space, at z = 0. loadPcd() returns a map in space.
GAUSSMAP_API void savePcd(const std::filesystem::path& path, const GaussianMap<2>& map,
                          const ExportOptions& options = {});

/// Reads a map from a file of savePcd(). Throws FileError if the file is not a cloud of Gaussians.
GAUSSMAP_API GaussianMap<3> loadPcd(const std::filesystem::path& path);

/// Returns true if a file begins like an SQLite database, as a .gmap file does. Returns false for any other file and
/// for a missing file.
GAUSSMAP_API bool isGmap(const std::filesystem::path& path);
/// Returns true if isGmap() is true, or if the file is a PCD file with the field `covariance`, as clouds of Gaussians
/// have it. The rest of the file is not checked.
GAUSSMAP_API bool isMap(const std::filesystem::path& path);
/// Reads a map from a .gmap file or from a cloud of Gaussians, detected by the first bytes of the file. If `metadata`
/// is given, it receives the metadata of a .gmap file. Throws like load() and loadPcd().
GAUSSMAP_API GaussianMap<3> loadAny(const std::filesystem::path& path, MapMetadata* metadata = nullptr);

}  // namespace gaussmap
