// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns the colour of an error as 0xRRGGBB: blue at 0, then cyan, green and yellow in equal steps, red from `red`
/// on. If `red` is 0, every error is blue.
GAUSSMAP_API std::uint32_t errorColour(double error, double red);

/// Writes points [m] and their errors as a PCD file with the fields x y z error rgb (rgb packed in a float, as in PCL).
/// Errors from their 99 % quantile on are red. Replaces an existing file. If points are more than 16 km from the
/// origin, the coordinates are relative to a multiple of 1024 m near them, which becomes the VIEWPOINT. Floats then
/// resolve 2 mm. Throws std::invalid_argument if there are no points, if the number of errors is not the number of
/// points, or if an error is not finite; FileError if the file cannot be written.
GAUSSMAP_API void writeErrorCloud(const std::filesystem::path& path, const std::vector<Vector<3>>& points,
                                  const std::vector<double>& errors);

}  // namespace gaussmap::detail
