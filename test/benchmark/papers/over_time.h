// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/mapping/online/online_mapper.h"
#include "papers/report.h"
#include "papers/sequences.h"

namespace gaussmap::papers {

/// A coarse scale after some scans.
struct Checkpoint {
  std::size_t scans = 0;      ///< number of scans in the map
  std::size_t cells = 0;      ///< number of occupied cells of the scale
  std::size_t gaussians = 0;  ///< number of Gaussians of the scale
  DistanceSummary fixed;      ///< distances of a fixed number of samples
  DistanceSummary growing;    ///< distances of samples of a fixed density: their number grows with the map
};

/// A map that was made on line, scan by scan.
struct OnlineRun {
  std::string method;
  double budget = 1.0;      ///< maximum Gaussians per coarse cell; 1: never refined
  bool is_limited = false;  ///< a refinement adds at most 4 clusters, as in the paper; false: no limit but the budget
  std::vector<std::vector<Checkpoint>> scale;          ///< per scale: the checkpoints; empty for scale 0
  std::size_t finest = 0;                              ///< Gaussians of the finest scale at the end
  double update = 0.0, occupancy = 0.0, refine = 0.0;  ///< seconds: by points; image and occupancy; refinement
};

/// The maps of one sequence. The first run is that without refinement.
struct OverTime {
  std::string name;
  int dimensions = 3;
  double resolution = 0.0;  ///< side of the finest cells [m]
  std::size_t scans = 0;
  std::vector<OnlineRun> runs;
};

/// Returns the run of a method with 4 Gaussians per cell. Throws std::out_of_range if it does not exist.
const OnlineRun& runOf(const OverTime& results, const std::string& method, bool is_limited);

/// Runs Yguel 2009 sec. 6: maps the sequence on line with each method and budget (1, 3.4 and 4 Gaussians per cell), and
/// measures every coarse scale at `checkpoints` times. The methods are also run without the limit of 4 clusters per
/// refinement, because few scans do not use up the budget with it.
template <int D>
OverTime runOverTime(const Sequence<D>& sequence, int checkpoints);

/// Adds the table and the plots of these runs to the report.
void reportOverTime(const OverTime& results, Report& report);

}  // namespace gaussmap::papers
