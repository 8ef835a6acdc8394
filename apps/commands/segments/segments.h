// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "commands/segments/fitter_options.h"
#include "commands/segments/laser_input.h"
#include "drawing/segment_picture.h"
#include "gaussmap/segments/segment_fitter.h"

namespace gaussmap::app {

struct SegmentsCommand {
  LaserInput input;
  FitterInput fitter;
  std::vector<std::string> outputs;
  std::string stats, evaluate, walls;
  int every = 1;
  bool force = false, evidence = false, json = false;
};

/// A map of segments, and the results of its fitting.
struct FittedSegments {
  SegmentMap map;
  std::vector<Vector<2>> evidence;
  std::vector<LaserScan> left_out;  // scans that --every leaves out
  std::size_t scans = 0, beams = 0, memory = 0;
  double seconds = 0.0;  // time of the fitting
  std::optional<SegmentPicture::Field> field;
  std::string statistics;  // as CSV
  SegmentStatistics last;
  std::size_t splits = 0, merges = 0, pruned = 0;
};

/// Fits segments to every N-th scan (--every). Throws FileError if no beam has a return.
FittedSegments fitSegments(const SegmentsCommand& command, const LaserScans& input);

/// Returns the scans for the score: those of --evaluate, or, if --evaluate is an input, the scans that --every left
/// out. Throws UsageError if there are no such scans.
LaserScans testScans(const SegmentsCommand& command, const std::vector<LaserScan>& left_out);

/// Throws UsageError if writeSegments() does not support the extension of the file.
void checkSegmentsName(const std::string& path);
/// Writes the map. The extension of the file chooses the format.
void writeSegments(const std::string& path, const FittedSegments& fitted);

}  // namespace gaussmap::app
