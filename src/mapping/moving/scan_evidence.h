// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap::detail {

/// Which scans hit and which passed through each finest cell of a map that was built from them (MovingPoints, step
/// evidence). `progress` is called with the number of scans done. Throws FileError for a damaged file;
/// std::out_of_range, naming file and point, for a point too far for the cells; std::invalid_argument, naming the
/// option.
ScanEvidence gatherEvidence(const GaussianMap<3>& map, const Scans& scans, const ScanEvidenceOptions& options = {},
                            const std::function<void(std::size_t)>& progress = {});

}  // namespace gaussmap::detail
