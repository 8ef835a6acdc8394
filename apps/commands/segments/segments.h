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
  std::string observation;  // SCAN:BEAM, or empty
  std::vector<double> box;  // x0 y0 x1 y1 of the picture, or empty
  int every = 1;
  bool force = false, evidence = false, evidence_beside = false, json = false;
};

/// A map of segments, and the results of its fitting.
struct FittedSegments {
  SegmentMap map;
  SegmentPicture picture;           // what the picture shows besides the map
  std::vector<LaserScan> left_out;  // scans that --every leaves out
  std::size_t scans = 0, beams = 0, memory = 0;
  double seconds = 0.0;    // time of the fitting
  std::string statistics;  // as CSV
  SegmentStatistics last;
  std::size_t splits = 0, merges = 0, pruned = 0;
  std::size_t observer_splits = 0, observer_merges = 0;  // of the observer of --observer-path
};

/// Fits segments to every N-th scan (--every). Throws FileError if no beam has a return.
FittedSegments fitSegments(const SegmentsCommand& command, const LaserScans& input);

/// Returns the scans for the score: those of --evaluate, or, if --evaluate is an input, the scans that --every left
/// out. Throws UsageError if there are no such scans.
LaserScans testScans(const SegmentsCommand& command, const std::vector<LaserScan>& left_out);

/// Returns the positions of --observer-path [m, map frame]. The file has "x y" per line, or is a pose file. Throws
/// FileError if it cannot be read, has a line that is not a position, or has no position.
std::vector<Vector<2>> readObserverPath(const std::string& path);

/// Draws the observation of --observation into each output and prints a line. Throws UsageError if there is no such
/// beam, or if it has no return.
void drawOneObservation(const SegmentsCommand& command, const LaserScans& input);

/// Throws UsageError if writeSegments() does not support the extension of the file.
void checkSegmentsName(const std::string& path);
/// Writes the map. The extension of the file chooses the format.
void writeSegments(const std::string& path, const FittedSegments& fitted);

}  // namespace gaussmap::app
