// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap::detail {

// Options are checked before any scan is read. Each function is defined beside the code that uses the options.
void checkOptions(const ScanEvidenceOptions& options);
void checkOptions(const MovingCellOptions& options, double resolution);
void checkOptions(const SharedCellOptions& options, double resolution);

}  // namespace gaussmap::detail
