// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/segment_map.h"

#include <algorithm>

namespace gaussmap {

Vector<2> Segment::direction() const {
  const Vector<2> along = end - start;
  const double length = along.norm();
  return length > 0.0 ? Vector<2>(along / length) : Vector<2>(1.0, 0.0);
}

Vector<2> Segment::normal() const {
  const Vector<2> along = direction();
  return {-along.y(), along.x()};
}

double Segment::distance(const Vector<2>& point) const {
  const Vector<2> along = direction();
  const double nearest = std::clamp(along.dot(point - start), 0.0, length());
  return (start + nearest * along - point).norm();
}

double SegmentMap::totalLength() const {
  double sum = 0.0;
  for (const Segment& segment : segments) sum += segment.length();
  return sum;
}

}  // namespace gaussmap
