// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/scans.h"
#include "io/pcd/pcd_records.h"

namespace gaussmap::detail {

/// Returns the points and all values of a scan that is not a PCD file. Coordinates and values become floats (F 4) if
/// floats hold them exactly, whole numbers become U 4 if they are in its range, and the rest become doubles (F 8).
/// Throws FileError like ScanReader::read().
GAUSSMAP_API PcdRecords recordsOf(const ScanReader& reader, const Pose& viewpoint);

}  // namespace gaussmap::detail
