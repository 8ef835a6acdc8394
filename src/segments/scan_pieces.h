// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "segments/scan_beams.h"

namespace gaussmap::detail {

/// A run of neighbouring beams [first, last).
struct BeamRun {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Returns the maximal runs of neighbouring beams that returned and whose ends are less than `gap` [m] apart. A bearing
/// step of more than 1.5 times the smallest step also ends a run, because some scans omit beams without a return.
std::vector<BeamRun> findRuns(const ScanBeams& beams, double gap);

/// Returns per beam the vector from the first to the last beam end of the straight piece of surface that it belongs to
/// [m]. The sensor is on the left of this vector. It is zero if the neighbours do not show a direction. The pieces of
/// each run come from an iterative end-point fit with this tolerance [m].
std::vector<Vector<2>> straightPieces(const std::vector<BeamRun>& runs, const std::vector<Vector<2>>& hits,
                                      double tolerance);

}  // namespace gaussmap::detail
