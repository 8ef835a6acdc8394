// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "gaussmap/segments/segment_map.h"

namespace gaussmap::app {

/// What stands beside the segments in a picture.
struct SegmentPicture {
  std::vector<Vector<2>> evidence;  ///< points [m], map frame
  /// A round field of view that the map has more detail in [m].
  struct Field {
    Vector<2> centre{0.0, 0.0};
    double radius = 0.0;
  };
  std::optional<Field> field;
};

/// Writes SVG: each chain in a colour, its segments with their end points, a pale band on the side that is free, a
/// scale bar. Throws FileError if it cannot be written.
void drawSegments(const SegmentMap& map, const SegmentPicture& picture, const std::filesystem::path& path);

}  // namespace gaussmap::app
