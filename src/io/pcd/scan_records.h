// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/scans.h"
#include "io/pcd/pcd_records.h"

namespace gaussmap::detail {

/// Returns the points and all values of a scan that is not a PCD file. Coordinates and values become floats (F 4) if
/// floats hold them exactly, else doubles (F 8). Times always become doubles. Colours, and values that count or number
/// something, such as "ring", become U 4 if all are whole.
/// Throws FileError like ScanReader::read().
GAUSSMAP_API PcdRecords recordsOf(const ScanReader& reader, const Pose& viewpoint);

}  // namespace gaussmap::detail
