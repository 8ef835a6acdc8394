// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap::detail {

/// Returns one flag per finest cell of a map: true if the cell held an object that has moved (MovingPoints, steps free
/// and grow). `evidence` = result of gatherEvidence(), per finest cell. Throws std::invalid_argument if the number of
/// entries of `evidence` differs from the number of cells, or if an option is out of range.
std::vector<bool> findMovingCells(const GaussianMap<3>& map, const std::vector<Evidence>& evidence,
                                  const MovingCellOptions& options = {});

}  // namespace gaussmap::detail
