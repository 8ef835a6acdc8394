// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap::detail {

/// Counts for each finest cell of a map how often the scans hit it and how often they passed through it (MovingPoints,
/// step evidence). The map must be built from these scans. `progress` is called with the number of scans done.
///
/// Throws FileError if a file is damaged. Throws std::out_of_range if a point lies beyond the range of 32-bit cell
/// indices; the message gives the scan and the point. Throws std::invalid_argument if an option is out of range; the
/// message names the option.
ScanEvidence gatherEvidence(const GaussianMap<3>& map, const Scans& scans, const ScanEvidenceOptions& options = {},
                            const std::function<void(std::size_t)>& progress = {});

}  // namespace gaussmap::detail
