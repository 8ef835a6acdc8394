// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "segments/scan_beams.h"

namespace gaussmap::detail {

/// Neighbouring beams [first, last).
struct BeamRun {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Maximal runs of neighbouring beams that returned and end less than `gap` apart [m]. Where a scan leaves beams
/// without return out, a step of the bearings of more than 1.5 times the smallest one ends a run.
std::vector<BeamRun> findRuns(const ScanBeams& beams, double gap);

/// For every beam from the first to the last end of the straight piece of surface that it belongs to [m], the sensor on
/// the left; zero where neighbours do not tell. The pieces of each run, by iterative end-point fit with this tolerance
/// [m].
std::vector<Vector<2>> straightPieces(const std::vector<BeamRun>& runs, const std::vector<Vector<2>>& hits,
                                      double tolerance);

}  // namespace gaussmap::detail
