// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap::detail {

/// Which finest cells of a map held an object that has moved (MovingPoints, steps free and grow); `evidence` as
/// gatherEvidence() gives it. Throws std::invalid_argument if there is not one evidence per cell, or an option is not
/// usable.
std::vector<bool> findMovingCells(const GaussianMap<3>& map, const std::vector<Evidence>& evidence,
                                  const MovingCellOptions& options = {});

}  // namespace gaussmap::detail
