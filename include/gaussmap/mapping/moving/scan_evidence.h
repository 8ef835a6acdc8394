// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/accumulate_scans.h"
#include "gaussmap/sensor/projection.h"
#include "gaussmap/sensor/visibility.h"

namespace gaussmap {

struct ScanEvidenceOptions {
  double max_range = std::numeric_limits<double>::infinity();  ///< farther points hit no cell, but free the way [m]
  std::optional<Projection> projection;     ///< of every scan; nothing: found for each from its points
  std::optional<double> no_return_is_free;  ///< pixels without return are free space up to this range [m]
  VisibilityOptions visibility;
  int threads = 0;  ///< 0 = all; never shows in the result
};

struct ScanEvidence {
  std::vector<Evidence> cells;    ///< of the finest cells of the map, in their order
  std::size_t cells_tested = 0;   ///< of the coarser scales, summed over the scans
  std::size_t cells_visited = 0;  ///< of the finest scale: what culling left to look at
};

/// Which scans hit and which passed through each finest cell of a map that was built from them. A scan with a point
/// in a cell hits it, whatever its other beams do; else a scan passes through the cell if it passes through the mean
/// of its points (visibilityOf()). Yguel 2009, sec. 4.1 and 4.2, with one sample a cell.
/// `progress` is called with the number of scans done. Throws FileError for a damaged file; std::out_of_range, naming
/// file and point, for a point too far for the cells; std::invalid_argument, naming the option.
ScanEvidence gatherEvidence(const GaussianMap<3>& map, const Scans& scans, const ScanEvidenceOptions& options = {},
                            const std::function<void(std::size_t)>& progress = {});

}  // namespace gaussmap
