// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/segments/laser_scan.h"
#include "segments/level_scan.h"

// Scans for planar maps: those of a planar laser, or slices of 3-D scans.
namespace gaussmap::app {

/// Two heights of the map frame, z0 <= z1 [m]. Empty: the scans must be those of a planar laser.
using Slice = std::vector<double>;

/// Adds --slice.
Option addSlice(Command& command, Slice& slice);
/// Throws UsageError if the heights are not in order.
void checkSlice(const Slice& slice);

/// Returns the heights, and the limits of the ranges and the box, for planarScan() and levelled().
PlanarScanOptions planarOptions(const Slice& slice, const AccumulateOptions& limits);
/// Returns the limits with the heights of the slice, for readers of points in space. Throws UsageError if `crop`, the
/// numbers of --crop, has heights too.
AccumulateOptions withSlice(AccumulateOptions limits, const Slice& slice, const std::vector<double>& crop);

/// Returns a scan for a planar map: its points between the heights, or the points of a planar laser. Throws FileError
/// with the name of the scan if it is a 3-D scan, and there is no slice.
Scan levelScan(const Scans& scans, std::size_t index, const Slice& slice);
/// The same, but of the points between the heights, only the nearest in each direction: a sweep whose beams show what
/// is free. `min_range`: nearer points do not hide others [m].
Scan sweepOf(const Scans& scans, std::size_t index, const Slice& slice, double min_range);

/// Calls read(scans) with the scans that a map of D dimensions reads. If they must be those of a planar laser, they are
/// checked when they are read.
template <int D, typename Read>
auto readChecked(const Scans& scans, const Slice& slice, const Read& read) {
  if (D == 2 && slice.empty()) return read(detail::PlanarLaserScans(scans));
  return read(scans);
}

}  // namespace gaussmap::app
