// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "gaussmap/core/error.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What a PLY file of a map holds.
enum class PlyContent {
  Ellipsoids,  ///< coloured triangles for any mesh viewer: 26 vertices and 48 triangles per Gaussian
  Points,      ///< means with normals, colours and weights
  Splats       ///< the layout of 3D Gaussian splatting (Kerbl et al. 2023) for any splat viewer
};

/// What the colours of a PLY file show.
enum class PlyColour {
  Height,  ///< height of the mean, in the viridis colour scale
  Normal   ///< direction of the normal: blue along x, red along y, sand along z (a horizontal surface)
};

/// Options of savePly().
struct GaussianPlyOptions {
  PlyContent content = PlyContent::Ellipsoids;  ///< ellipsoids, points or splats
  PlyColour colour = PlyColour::Height;         ///< what the colours show
  std::optional<int> scale;                     ///< the scale to write; std::nullopt: the leaves, see leaves()
  double sigma = 2.0;                           ///< half axes of the ellipsoids, in standard deviations, > 0
};

/// Writes the Gaussians of a map to a binary little-endian PLY file of floats, and returns their number.
///
/// Far from the origin, floats do not resolve a thousandth of a finest cell. The coordinates are then relative to a
/// nearer origin, at multiples of 1024 m. The header gives this origin, to be added to x y z: `comment origin X Y Z`.
///
/// PlyContent::Splats has the fields x y z, nx ny nz, f_dc_0..2, f_rest_0..44, opacity, scale_0..2 and rot_0..3. All
/// f_rest are zero, because the colour is the same from all directions; some viewers require all 45. opacity is the
/// log-odds of occupancy; a viewer applies the sigmoid to it. scale is the natural logarithm of the standard deviations
/// [m], rot is a unit quaternion (w x y z). The covariance is `R diag(exp(scale))^2 R'`.
///
/// The write is atomic. Throws:
/// - std::invalid_argument if sigma is not positive and finite
/// - std::out_of_range if the map does not have the scale
/// - std::length_error if the ellipsoids have more vertices than a mesh can have (2^31)
/// - FileError if the file cannot be written
GAUSSMAP_API std::size_t savePly(const std::filesystem::path& path, const GaussianMap<3>& map,
                                 const GaussianPlyOptions& options = {});

/// Writes the Gaussians of a map to an XML PolyData file of VTK (.vtp) for ParaView, and returns their number.
///
/// The file holds all scales, coarsest first, or the given scale, in the order of the map. There is one point per
/// Gaussian, in doubles, as raw appended data. The point data are:
/// - covariance: 9 numbers [m^2]
/// - deviation: 9 numbers [m], the symmetric square root of the covariance. To draw ellipsoids of two standard
///   deviations in ParaView, apply the filter "Tensor Glyph" to it. Use a sphere of radius 0.5 and a scale factor of 4,
///   and do not limit the size of the glyphs.
/// - normal, weight, log_odds, occupancy (probability), scale, cell_side [m]
/// - parent: index of the point of the parent Gaussian; -1 if the parent is not in the file
///
/// The write is atomic, and the same map gives the same bytes. Throws std::out_of_range if the map does not have the
/// scale, and FileError if the file cannot be written.
GAUSSMAP_API std::size_t saveVtp(const std::filesystem::path& path, const GaussianMap<3>& map,
                                 std::optional<int> scale = std::nullopt);

/// Writes the Gaussians of a map to a CSV file, and returns their number.
///
/// The first line gives the names: scale, cell_side, cell_x, cell_y, cell_z, x, y, z, cov_xx, cov_xy, cov_xz, cov_yy,
/// cov_yz, cov_zz, weight, log_odds. Then there is one line per Gaussian, in the same order as in saveVtp(). The
/// numbers have enough digits to restore the same doubles. Writes and throws like saveVtp().
GAUSSMAP_API std::size_t saveCsv(const std::filesystem::path& path, const GaussianMap<3>& map,
                                 std::optional<int> scale = std::nullopt);

/// Writes a planar map like a map in space, see savePly() above. All means have z = 0, and the standard deviation
/// across the plane is MapOptions::noise.
GAUSSMAP_API std::size_t savePly(const std::filesystem::path& path, const GaussianMap<2>& map,
                                 const GaussianPlyOptions& options = {});
/// Writes a planar map like a map in space, with the same z and standard deviation as savePly().
GAUSSMAP_API std::size_t saveVtp(const std::filesystem::path& path, const GaussianMap<2>& map,
                                 std::optional<int> scale = std::nullopt);
/// Writes a planar map like a map in space, with the same z and standard deviation as savePly().
GAUSSMAP_API std::size_t saveCsv(const std::filesystem::path& path, const GaussianMap<2>& map,
                                 std::optional<int> scale = std::nullopt);

}  // namespace gaussmap
