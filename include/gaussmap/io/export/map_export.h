// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "gaussmap/core/error.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

enum class PlyContent {
  Ellipsoids,  ///< coloured triangles, for every viewer of meshes: 26 corners and 48 triangles a Gaussian
  Points,      ///< means with normals, colours and weights
  Splats       ///< the layout of 3D Gaussian splatting (Kerbl et al. 2023), for every viewer of splats
};

enum class PlyColour {
  Height,  ///< of the mean, viridis()
  Normal   ///< normalColour()
};

struct GaussianPlyOptions {
  PlyContent content = PlyContent::Ellipsoids;
  PlyColour colour = PlyColour::Height;
  std::optional<int> scale;  ///< nothing: leaves(), the map at its finest
  double sigma = 2.0;        ///< half axes of the ellipsoids, in standard deviations; > 0
};

/// Writes Gaussians as a binary little-endian PLY file of floats, whole or not at all (AtomicFile); returns how many.
/// Maps so far away that floats would lose a thousandth of a finest cell are written about an origin, a multiple of
/// 1024 m, which stands in the header: `comment origin X Y Z`, to be added to x y z.
/// Splats: x y z, nx ny nz, f_dc_0..2 and f_rest_0..44 (colour from everywhere the same: zeros, for there are viewers
/// that insist on all 45), opacity (before the sigmoid, so it is the log-odds of occupancy), scale_0..2 (natural
/// logarithms of the standard deviations [m]), rot_0..3 (w x y z, unit); R diag(exp(scale))^2 R' is the covariance.
/// Throws std::invalid_argument for a sigma that is not positive and finite; std::out_of_range for a scale that the map
/// does not have; std::length_error for more ellipsoids than a mesh can have corners (2^31); FileError if the file
/// cannot be written.
GAUSSMAP_API std::size_t savePly(const std::filesystem::path& path, const GaussianMap<3>& map,
                                 const GaussianPlyOptions& options = {});

// The Gaussians of a map with all that it knows of them, in doubles, for other programs. Those of all scales (coarsest
// first) or of one, in the order of the map. Whole files or none (AtomicFile), the same bytes for the same map; they
// return how many there were. They throw std::out_of_range for a scale that the map does not have, FileError if the
// file cannot be written.

/// XML PolyData of VTK (.vtp), for ParaView: a point a Gaussian, the data appended raw. Of the points: covariance (9
/// numbers [m^2]), deviation (its symmetric root [m], the tensors to draw: filter "Tensor Glyph" of a sphere of radius
/// 0.5, scale factor 4, not limited, is the ellipsoid of two standard deviations), normal, weight, log_odds,
/// occupancy (probability), scale, cell_side [m], parent (the point of the coarser Gaussian that it belongs to; -1 if
/// there is none in the file).
GAUSSMAP_API std::size_t saveVtp(const std::filesystem::path& path, const GaussianMap<3>& map,
                                 std::optional<int> scale = std::nullopt);

/// Text with one line a Gaussian under a line of names: scale,cell_side,cell_x,cell_y,cell_z,x,y,z,cov_xx,cov_xy,
/// cov_xz,cov_yy,cov_yz,cov_zz,weight,log_odds. Numbers have the digits that give back the same double.
GAUSSMAP_API std::size_t saveCsv(const std::filesystem::path& path, const GaussianMap<3>& map,
                                 std::optional<int> scale = std::nullopt);

}  // namespace gaussmap
