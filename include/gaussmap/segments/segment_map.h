// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A straight piece of wall as a planar laser sees it, map frame. It is oriented: seen from start towards end, the free
/// space that it was observed from is on the left. The two faces of a thin wall are two segments.
/// Leal, Scheding, Dissanayake 2000, sec. 3.
struct GAUSSMAP_API Segment {
  Vector<2> start{0.0, 0.0};  ///< end points [m]
  Vector<2> end{0.0, 0.0};
  double normal_variance = 0.0;  ///< sigma_n^2, variance of the evidence across the line [m^2], eq. [2]
  /// Of the line: (offset along the normal at the segment's middle [m], angle [rad]), symmetric positive definite.
  Matrix<2> covariance = Matrix<2>::Zero();
  double weight = 0.0;         ///< observations that it represents
  std::int64_t last_seen = 0;  ///< number of the last scan that saw it, 0 = the first scan

  double length() const { return (end - start).norm(); }
  /// Unit vector from start to end; (1, 0) if they coincide.
  Vector<2> direction() const;
  /// Unit normal on the left, towards free space.
  Vector<2> normal() const;
  /// Distance of a point to the segment, end points included [m].
  double distance(const Vector<2>& point) const;
};

/// A 2-D map of line segments linked into chains. Each segment is in exactly one chain; the end of a segment is the
/// start of the next one of its chain where their lines meet near both, else a short way from it.
struct GAUSSMAP_API SegmentMap {
  struct Chain {
    std::size_t first = 0;  ///< segments [first, last) of the map, in the order of the chain
    std::size_t last = 0;
    bool closed = false;  ///< the last segment is linked to the first
  };
  std::vector<Segment> segments;  ///< chain after chain
  std::vector<Chain> chains;      ///< in order of their first segment

  /// Sum of the segments' lengths [m].
  double totalLength() const;
};

}  // namespace gaussmap
