// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "segments/evidence_collector.h"
#include "segments/scan_beams.h"
#include "segments/scan_pieces.h"
#include "segments/segment_store.h"

namespace gaussmap::detail {

/// Returns per beam the number of the segment that it belongs to, or kNone: see SegmentAssociation. Leal 2000 sec. 4.3.
/// `observations`: of this scan.
std::vector<int> associate(const ScanBeams& beams, const std::vector<BeamRun>& runs,
                           const EvidenceCollector& observations, const SegmentStore& store,
                           const SegmentFitterOptions& options);

}  // namespace gaussmap::detail
