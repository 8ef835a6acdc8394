// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/free_space.h"
#include "segments/live_segment.h"

namespace gaussmap::detail {

/// Returns a better set of segments for the same evidence. It considers all segments together, and chooses the lines
/// that explain the most evidence for their cost. `views` shows where rays have passed through. Does not change the
/// given segments.
std::deque<LiveSegment> optimiseSegments(const std::deque<LiveSegment>& segments, const Views& views,
                                         const SegmentFitterOptions& options);

}  // namespace gaussmap::detail
