// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/segments/laser_scan.h"

namespace gaussmap::detail {

/// A scan with its coordinates relative to the origin of the map's sums.
struct ScanBeams {
  LaserScan scan;
  std::vector<Vector<2>> hits;     ///< ends of the beams that returned [m]; zero for the others
  std::uint64_t first_number = 0;  ///< number of the observation of beam 0

  explicit ScanBeams(const LaserScan& original, const Vector<2>& origin = {0.0, 0.0}, std::uint64_t number = 0)
      : scan(original), hits(original.ranges.size(), Vector<2>(0.0, 0.0)), first_number(number) {
    scan.pose.translation -= origin;
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (scan.returned(i)) hits[i] = scan.hit(i);
  }
  const Vector<2>& sensor() const { return scan.pose.translation; }
};

}  // namespace gaussmap::detail
