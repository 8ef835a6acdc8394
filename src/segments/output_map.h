// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "gaussmap/segments/segment_map.h"
#include "segments/live_segment.h"

namespace gaussmap::detail {

/// Returns the segments in the map frame, chain by chain. Linked neighbours are joined where their lines meet.
/// `adjust_ends`: see SegmentFitterOptions.
SegmentMap outputMap(const std::deque<LiveSegment>& segments, const Vector<2>& origin, bool adjust_ends);

}  // namespace gaussmap::detail
