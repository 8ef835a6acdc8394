// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "common.h"

namespace gaussmap::app {

/// Draws the error curves of a map (as in its metadata) as SVG: Gaussians across, 95 % and mean error up, both
/// logarithmic. Throws FileError if it cannot be written.
void plotCurves(const Json& curves, const std::filesystem::path& path);

}  // namespace gaussmap::app
