// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap::detail {

// MovingPoints checks its options before it reads any scan. Each function is defined in the source file that uses its
// options. They throw std::invalid_argument; the message names the option.
void checkOptions(const ScanEvidenceOptions& options);
void checkOptions(const MovingCellOptions& options, double resolution);
void checkOptions(const SharedCellOptions& options, double resolution);

}  // namespace gaussmap::detail
