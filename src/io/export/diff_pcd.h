// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "gaussmap/core/error.h"
#include "gaussmap/editing/diff_maps.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Writes the differences of two maps at one scale as a PCD file. It holds all Gaussians of the second map, and those
/// of the first map that are gone.
///
/// Fields: x y z (floats, relative to the VIEWPOINT) covariance[6] weight p_value label (Change as a number). Throws
/// FileError if the file cannot be written.
GAUSSMAP_API void writeDiffPcd(const std::filesystem::path& path, const GaussianMap<3>& first,
                               const GaussianMap<3>& second, const MapDiff& diff, int scale);

}  // namespace gaussmap::detail
