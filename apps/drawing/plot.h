// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "gaussmap/mapping/refine.h"

namespace gaussmap::app {

/// Draws error curves as SVG: the number of Gaussians on the x axis, 95 % and mean error on the y axis, both
/// logarithmic. At least one curve must have a point. Throws FileError if the file cannot be written.
void plotCurves(const std::vector<ErrorCurve>& curves, const std::filesystem::path& path);

}  // namespace gaussmap::app
