// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "segments/scan_beams.h"
#include "segments/scan_pieces.h"
#include "segments/segment_store.h"

namespace gaussmap::detail {

/// Returns per beam the number of the segment that it belongs to, or kNone. This is the nearest segment that meets
/// three conditions: its polygon contains the end of the beam, the sensor is on its free side, and its direction fits
/// the surface there. Leal 2000 sec. 4.1.
std::vector<int> associate(const ScanBeams& beams, const std::vector<BeamRun>& runs, const SegmentStore& store,
                           const SegmentFitterOptions& options);

}  // namespace gaussmap::detail
