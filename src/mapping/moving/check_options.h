// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap::detail {

/// Throws std::invalid_argument, naming the option and its value, unless it is usable.
inline void require(bool usable, const std::string& option, double value, const std::string& rule) {
  if (!usable) throw std::invalid_argument(option + " = " + std::to_string(value) + ": " + rule);
}

// Throw std::invalid_argument, before any scan is read. Defined in scan_evidence.cpp, moving_cells.cpp and
// shared_cells.cpp.
void checkOptions(const ScanEvidenceOptions& options);
void checkOptions(const MovingCellOptions& options, double resolution);
void checkOptions(const SharedCellOptions& options, double resolution);

}  // namespace gaussmap::detail
