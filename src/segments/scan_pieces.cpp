// SPDX-License-Identifier: BSD-3-Clause
#include "segments/scan_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaussmap::detail {
namespace {

constexpr std::size_t kMinBeams = 3;    // minimum number of beams that show a direction ...
constexpr double kShortestPiece = 1.3;  // ... and minimum length of their piece, in tolerances

}  // namespace

std::vector<BeamRun> findRuns(const ScanBeams& beams, double gap) {
  const LaserScan& scan = beams.scan;
  const std::size_t count = scan.ranges.size();
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < count; ++i) {
    const double turn = scan.bearings[i] - scan.bearings[i - 1];
    if (turn > 0.0) step = std::min(step, turn);
  }
  std::vector<BeamRun> runs;
  for (std::size_t i = 0; i < count; ++i) {
    if (!scan.returned(i)) continue;
    const bool linked = !runs.empty() && runs.back().last == i &&
                        scan.bearings[i] - scan.bearings[i - 1] <= 1.5 * step &&
                        (beams.hits[i] - beams.hits[i - 1]).squaredNorm() < gap * gap;
    if (linked)
      ++runs.back().last;
    else
      runs.push_back({i, i + 1});
  }
  return runs;
}

std::vector<Vector<2>> straightPieces(const std::vector<BeamRun>& runs, const std::vector<Vector<2>>& hits,
                                      double tolerance) {
  std::vector<Vector<2>> pieces(hits.size(), Vector<2>(0.0, 0.0));
  std::vector<BeamRun> open(runs);
  while (!open.empty()) {
    const BeamRun run = open.back();
    open.pop_back();
    if (run.last - run.first < kMinBeams) continue;
    const Vector<2> chord = hits[run.last - 1] - hits[run.first];
    const double length = chord.norm();
    // Finds the beam farthest from the chord, or from its first end if the chord is too short to have a direction.
    std::size_t farthest = run.first;
    double most = 0.0;
    for (std::size_t i = run.first + 1; i + 1 < run.last; ++i) {
      const Vector<2> from = hits[i] - hits[run.first];
      const double distance =
          length > tolerance ? std::abs(chord.x() * from.y() - chord.y() * from.x()) / length : from.norm();
      if (distance > most) {
        most = distance;
        farthest = i;
      }
    }
    if (most <= tolerance) {
      if (length < kShortestPiece * tolerance) continue;
      for (std::size_t i = run.first; i < run.last; ++i) pieces[i] = chord;
      continue;
    }
    const bool with_left =
        (hits[farthest] - hits[farthest - 1]).squaredNorm() <= (hits[farthest + 1] - hits[farthest]).squaredNorm();
    const std::size_t border = with_left ? farthest + 1 : farthest;
    open.push_back({run.first, border});
    open.push_back({border, run.last});
  }
  return pieces;
}

}  // namespace gaussmap::detail
