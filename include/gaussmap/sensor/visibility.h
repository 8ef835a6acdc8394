// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "gaussmap/sensor/range_image.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What one scan says about a point in space.
enum class Visibility {
  OutOfView,     ///< no pixel there
  NoEvidence,    ///< too few of the beams around it came back
  Hidden,        ///< a beam around it ended before it
  AtSurface,     ///< close to where the beams ended
  PassedThrough  ///< all beams around it went on, and ended clearly behind it
};

/// When beams count as having passed through a point. In metres, not in cells: limits in cells that work at a
/// resolution of 0.1 m fail at 0.2 m.
struct VisibilityOptions {
  double tolerance = 0.3;   ///< all beams around the point end at least so much farther from the sensor [m], >= 0
  double clearance = 0.35;  ///< the surface they end on keeps this distance from the point [m], >= 0: on a road seen
                            ///< at a grazing angle a beam ends metres behind a point that lies on it
};

/// The visibility of a point [m, sensor frame] by the 3 x 3 pixels around it (1 x 3 in an image of one row), of which
/// at least half must have returns. One pixel alone would free thin objects and edges: its beam may pass beside them.
GAUSSMAP_API Visibility visibilityOf(const RangeImage& image, const Eigen::Vector3d& point,
                                     const VisibilityOptions& options = {});

/// What all scans said about one cell or cluster: enough to explain why it was kept or deleted.
struct Evidence {
  std::uint32_t hits = 0;       ///< scans that measured a point in it
  std::uint32_t misses = 0;     ///< scans whose beams passed through it
  std::uint32_t first_hit = 0;  ///< number of the first scan with a point in it; means nothing while hits == 0
  std::uint32_t last_hit = 0;   ///< and of the last one

  void hit(std::uint32_t scan) {
    first_hit = hits == 0 ? scan : std::min(first_hit, scan);
    last_hit = hits == 0 ? scan : std::max(last_hit, scan);
    ++hits;
  }
  void miss() { ++misses; }
};

/// How much one scan changes the log-odds that something is there. The defaults are those of OctoMap: probabilities of
/// 0.7 and 0.4. A static cell is kept if 32 % of the scans that see its place hit it.
struct OccupancyOptions {
  double hit = 0.85;  ///< added by a scan that measured a point there, > 0
  double miss = 0.4;  ///< taken off by a scan that passed through, > 0
  double max_log_odds =
      10.0;  ///< o_max: on line, log-odds stay within [-max_log_odds, max_log_odds], > 0 (Yguel 2009, sec. 4.1)
};

/// Log-odds of all scans together, without bounds, so the result does not depend on the order of the scans.
inline double logOdds(const Evidence& evidence, const OccupancyOptions& options = {}) {
  return evidence.hits * options.hit - evidence.misses * options.miss;
}

}  // namespace gaussmap
