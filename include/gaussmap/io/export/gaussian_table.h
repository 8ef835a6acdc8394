// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "gaussmap/core/error.h"
#include "gaussmap/map/gaussian_map.h"

// The Gaussians of a map with all that it knows of them, in doubles, for other programs. Those of all scales (coarsest
// first) or of one, in the order of the map. Whole files or none (AtomicFile), the same bytes for the same map; they
// return how many there were. They throw std::out_of_range for a scale that the map does not have, FileError if the
// file cannot be written.
namespace gaussmap {

/// XML PolyData of VTK (.vtp), for ParaView: a point a Gaussian, the data appended raw. Of the points: covariance (9
/// numbers [m^2]), deviation (its symmetric root [m], the tensors to draw: filter "Tensor Glyph" of a sphere of radius
/// 0.5, scale factor 4, not limited, is the ellipsoid of two standard deviations), normal, weight, log_odds,
/// occupancy (probability), scale, cell_side [m], parent (the point of the coarser Gaussian that it belongs to; -1 if
/// there is none in the file).
std::size_t writeGaussianVtp(const std::filesystem::path& path, const GaussianMap<3>& map,
                             std::optional<int> scale = std::nullopt);

/// Text with one line a Gaussian under a line of names: scale,cell_side,cell_x,cell_y,cell_z,x,y,z,cov_xx,cov_xy,
/// cov_xz,cov_yy,cov_yz,cov_zz,weight,log_odds. Numbers have the digits that give back the same double.
std::size_t writeGaussianCsv(const std::filesystem::path& path, const GaussianMap<3>& map,
                             std::optional<int> scale = std::nullopt);

}  // namespace gaussmap
