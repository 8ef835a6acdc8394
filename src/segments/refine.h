// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "segments/fitter_state.h"

namespace gaussmap::detail {

/// The segments of a state, all decided on together: which lines explain the most of its evidence for what they cost.
/// The state stays as it is.
std::deque<LiveSegment> refineSegments(const SegmentFitterState& state);

}  // namespace gaussmap::detail
