// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "gaussmap/sensor/range_image.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// How one scan observes a point in space.
enum class Visibility {
  OutOfView,     ///< no pixel sees the point
  NoEvidence,    ///< too few of the beams around the point returned
  Hidden,        ///< a beam around the point ended in front of it
  AtSurface,     ///< the beams ended close to the point
  PassedThrough  ///< all beams around the point ended clearly behind it
};

/// Decides when beams pass through a point. The limits are in metres, not in cells: limits in cells that work at a
/// resolution of 0.1 m fail at 0.2 m.
struct VisibilityOptions {
  double tolerance = 0.3;  ///< all beams around the point end at least this far behind it, by range [m], >= 0
  /// Minimum distance of the point from the surface on which the beams end [m], >= 0. On a road seen at a grazing
  /// angle, a beam ends metres behind a point that lies on the road.
  double clearance = 0.35;
};

/// Returns the visibility of a point [m, sensor frame] from the 3 x 3 pixels around it (1 x 3 in an image of one row).
///
/// At least half of these pixels must have returns. A single pixel would free thin objects and edges, because its beam
/// can pass beside them.
GAUSSMAP_API Visibility visibilityOf(const RangeImage& image, const Eigen::Vector3d& point,
                                     const VisibilityOptions& options = {});

/// The observations of one cell or cluster by all scans. They explain why it was kept or deleted.
struct Evidence {
  std::uint32_t hits = 0;       ///< number of scans that measured a point in the cell
  std::uint32_t misses = 0;     ///< number of scans whose beams passed through the cell
  std::uint32_t first_hit = 0;  ///< number of the first scan with a point in the cell; undefined if hits == 0
  std::uint32_t last_hit = 0;   ///< number of the last scan with a point in the cell; undefined if hits == 0

  /// Counts a hit by scan number `scan`.
  void hit(std::uint32_t scan) {
    first_hit = hits == 0 ? scan : std::min(first_hit, scan);
    last_hit = hits == 0 ? scan : std::max(last_hit, scan);
    ++hits;
  }
  /// Counts a miss.
  void miss() { ++misses; }
};

/// The changes of the occupancy log-odds by one scan. The defaults are those of OctoMap: probabilities of 0.7 and 0.4.
/// With them, a static cell is kept if 32 % of the scans that see its place hit it.
struct OccupancyOptions {
  double hit = 0.85;  ///< added by a scan that measured a point in the cell, > 0
  double miss = 0.4;  ///< subtracted by a scan that passed through the cell, > 0
  /// o_max, Yguel 2009 sec. 4.1: OnlineMapper keeps log-odds within [-max_log_odds, max_log_odds], > 0.
  double max_log_odds = 10.0;
};

/// Returns the log-odds of all scans together, without bounds. The result therefore does not depend on the order of the
/// scans.
inline double logOdds(const Evidence& evidence, const OccupancyOptions& options = {}) {
  return evidence.hits * options.hit - evidence.misses * options.miss;
}

}  // namespace gaussmap
