// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "segments/scan_beams.h"
#include "segments/scan_pieces.h"
#include "segments/segment_store.h"

namespace gaussmap::detail {

/// For every beam the number of the segment that it belongs to, kNone if it belongs to none: the nearest segment whose
/// polygon contains the end of the beam, that is seen from its free side, and whose direction fits the surface there.
/// Leal 2000 sec. 4.1.
std::vector<int> associate(const ScanBeams& beams, const std::vector<BeamRun>& runs, const SegmentStore& store,
                           const SegmentFitterOptions& options);

}  // namespace gaussmap::detail
