// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace gaussmap {

/// What the scans said about one cell or cluster: enough to explain why it was kept or deleted.
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

/// How much a scan changes the log-odds that something is there. The defaults are those that users of OctoMap know:
/// probabilities of 0.7 and 0.4. A cell that holds still is kept if 32 % of the scans that see its place hit it.
struct OccupancyOptions {
  double hit = 0.85;   ///< added by a scan that measured a point there, > 0
  double miss = 0.4;   ///< taken off by a scan that passed through, > 0
  double most = 10.0;  ///< o_max: on line, log-odds stay within [-most, most], > 0 (Yguel 2009, sec. 4.1)
};

/// Log-odds of all scans taken together, without bounds: what is decided does not depend on their order.
inline double logOdds(const Evidence& evidence, const OccupancyOptions& options = {}) {
  return evidence.hits * options.hit - evidence.misses * options.miss;
}

}  // namespace gaussmap
