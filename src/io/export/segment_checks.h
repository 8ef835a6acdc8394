// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "gaussmap/segments/segment_map.h"

namespace gaussmap::detail {

inline bool isFinite(const Segment& segment) {
  return segment.start.allFinite() && segment.end.allFinite() && segment.covariance.allFinite() &&
         std::isfinite(segment.normal_variance) && std::isfinite(segment.weight);
}

/// Checks that all numbers are finite and that each segment is in exactly one chain. Throws std::invalid_argument with
/// the number of the segment or chain.
inline void checkSegments(const SegmentMap& map) {
  for (std::size_t i = 0; i < map.segments.size(); ++i)
    if (!isFinite(map.segments[i])) throw std::invalid_argument("segment " + std::to_string(i) + " is not finite");
  std::size_t next = 0;
  for (std::size_t i = 0; i < map.chains.size(); ++i) {
    if (map.chains[i].first != next || map.chains[i].last <= next || map.chains[i].last > map.segments.size())
      throw std::invalid_argument("chain " + std::to_string(i) + " does not start where the chain before it ends");
    next = map.chains[i].last;
  }
  if (next != map.segments.size()) throw std::invalid_argument("segment " + std::to_string(next) + " is in no chain");
}

}  // namespace gaussmap::detail
