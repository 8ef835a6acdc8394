// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/segment_map.h"

namespace gaussmap {

double SegmentMap::totalLength() const {
  double sum = 0.0;
  for (const Segment& segment : segments) sum += segment.length();
  return sum;
}

}  // namespace gaussmap
