// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/free_space.h"
#include "segments/live_segment.h"

namespace gaussmap::detail {

/// A better set of segments for the same evidence: all are decided on together, by which lines explain the most of the
/// evidence for what they cost. `views` shows which places rays have passed through. The given segments are not
/// changed.
std::deque<LiveSegment> optimiseSegments(const std::deque<LiveSegment>& segments, const Views& views,
                                         const SegmentFitterOptions& options);

}  // namespace gaussmap::detail
