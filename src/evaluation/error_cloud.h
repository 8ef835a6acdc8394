// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// Colour of an error as 0xRRGGBB: blue at 0, then cyan, green and yellow in equal steps, red from `red` on. All is
/// blue if red is 0.
std::uint32_t errorColour(double error, double red);

/// Writes points [m] and their errors as a PCD file with the fields x y z error rgb (rgb packed in a float, as PCL has
/// it), red from the 99 % quantile of the errors on; what is there is replaced. Points more than 16 km from the
/// origin are written about one near them, a multiple of 1024 m, which becomes the VIEWPOINT: floats resolve 2 mm.
/// Throws std::invalid_argument if there are no points, not as many errors, or an error is not finite; FileError if the
/// file cannot be written.
void writeErrorCloud(const std::filesystem::path& path, const std::vector<Vector<3>>& points,
                     const std::vector<double>& errors);

}  // namespace gaussmap::detail
