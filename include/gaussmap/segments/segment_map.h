// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/segments/segment.h"

namespace gaussmap {

/// A 2-D map of line segments linked into chains. Each segment is in exactly one chain; the end of a segment is the
/// start of the next one of its chain where their lines meet near both, else a short way from it.
struct SegmentMap {
  struct Chain {
    std::size_t first = 0;  ///< segments [first, last) of the map, in the order of the chain
    std::size_t last = 0;
    bool closed = false;  ///< the last segment is linked to the first
  };
  std::vector<Segment> segments;  ///< chain after chain
  std::vector<Chain> chains;      ///< in order of their first segment

  /// Sum of the segments' lengths [m].
  double totalLength() const;
};

}  // namespace gaussmap
