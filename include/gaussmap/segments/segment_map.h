// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A straight piece of wall in the map frame, as in Leal, Scheding, Dissanayake 2000, sec. 3.
///
/// A segment is oriented: seen from start to end, the free space from which it was observed is on the left. The two
/// faces of a thin wall are two segments.
struct GAUSSMAP_API Segment {
  Vector<2> start{0.0, 0.0};     ///< first end point [m]
  Vector<2> end{0.0, 0.0};       ///< second end point [m]
  double normal_variance = 0.0;  ///< sigma_n^2, variance of the evidence at right angles to the line [m^2], eq. (2)
  /// Covariance of two errors of the line: its offset along the normal at the middle of the segment [m], and its angle
  /// [rad]. Symmetric positive definite.
  Matrix<2> covariance = Matrix<2>::Zero();
  double weight = 0.0;         ///< number of observations that the segment represents
  std::int64_t last_seen = 0;  ///< number of the last scan that observed the segment, 0 = the first scan

  /// Returns the length [m].
  double length() const { return (end - start).norm(); }
  /// Returns the unit vector from start to end, or (1, 0) if they coincide.
  Vector<2> direction() const;
  /// Returns the unit normal on the left, towards free space.
  Vector<2> normal() const;
  /// Returns the distance from a point to the nearest point of the segment [m].
  double distance(const Vector<2>& point) const;
};

/// A 2-D map of line segments, linked into chains. Each segment is in exactly one chain.
///
/// The end of a segment is linked to the start of the next one. If the lines of both meet near these points, both
/// points are moved to the intersection. Otherwise there is a short distance between them.
struct GAUSSMAP_API SegmentMap {
  /// A sequence of linked segments.
  struct Chain {
    std::size_t first = 0;  ///< index of the first segment of the chain
    std::size_t last = 0;   ///< index of the last segment, plus 1
    bool closed = false;    ///< true: the last segment is linked to the first
  };
  std::vector<Segment> segments;  ///< chain after chain, each in the order of its links
  std::vector<Chain> chains;      ///< in the order of Chain::first

  /// Returns the sum of the segments' lengths [m].
  double totalLength() const;
};

}  // namespace gaussmap
