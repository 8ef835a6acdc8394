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

/// One Gaussian as it stands in a PCD file, and as PCL's PointGaussian holds it.
struct GaussianRecord {
  std::array<float, 3> mean;        ///< x y z [m] about the origin of its records
  std::array<float, 6> covariance;  ///< xx xy xz yy yz zz [m^2]
  float weight;                     ///< points
  float occupancy;                  ///< log-odds; kMaxOccupancy where no scan was asked
  float cell_side;                  ///< [m]
  float scale;                      ///< 0 = finest; a float because pcl::PassThrough filters by nothing else
  std::array<std::int32_t, 3> cell;
};

struct GAUSSMAP_API GaussianRecords {
  std::vector<GaussianRecord> records;
  /// What to add to the means [m]: zero, but for maps so far away that floats would lose a thousandth of a finest
  /// cell. A multiple of 1024 m, so that a float holds it exactly. Written as the file's VIEWPOINT.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// The Gaussians of all scales (coarsest first) or of one, in key order.
/// Throws std::out_of_range for a scale that the map does not have.
GAUSSMAP_API GaussianRecords toRecords(const GaussianMap<3>& map, std::optional<int> scale = std::nullopt);

/// The map that such records describe. The grid follows from cell sides and scales; a finer Gaussian's parent is the
/// cluster of the cell above that is nearest under the KL divergence. Where floats have cost a covariance its
/// positive definiteness, the eigenvalues are lifted to 1e-6 of the largest. Coarse cells without finer ones make a
/// compressed map; one scale alone, whichever, becomes the finest scale of a map of one scale. Throws
/// std::invalid_argument, saying what, if they describe no map.
GAUSSMAP_API GaussianMap<3> fromRecords(const GaussianRecords& records);

/// Writes such records, and reads them, as the fields that savePcd() names. Throw FileError.
GAUSSMAP_API void saveRecordsPcd(const std::filesystem::path& path, const GaussianRecords& records);
GAUSSMAP_API GaussianRecords loadRecordsPcd(const std::filesystem::path& path);

struct ExportOptions {
  std::optional<int> scale;  ///< one scale only; nothing: all
  bool overwrite = false;
};

/// Writes a map, or one scale, as a PCD file with the fields
/// x y z covariance[6] weight occupancy cell_side scale cell_x cell_y cell_z, readable by PCL and its tools.
/// Throws FileError if the file exists and may not be replaced, or cannot be written.
GAUSSMAP_API void savePcd(const std::filesystem::path& path, const GaussianMap<3>& map,
                          const ExportOptions& options = {});

/// Reads what saveMapPcd wrote. Throws FileError if the file is no such cloud.
GAUSSMAP_API GaussianMap<3> loadPcd(const std::filesystem::path& path);

/// Does the file begin like an SQLite database, as a .gmap does? False for everything else, missing files included.
GAUSSMAP_API bool isGmap(const std::filesystem::path& path);
/// Does the file hold a .gmap or a cloud of Gaussians?
GAUSSMAP_API bool isMap(const std::filesystem::path& path);
/// load or loadPcd, by the first bytes of the file; the metadata of a .gmap on request.
GAUSSMAP_API GaussianMap<3> loadAny(const std::filesystem::path& path, MapMetadata* metadata = nullptr);

}  // namespace gaussmap
