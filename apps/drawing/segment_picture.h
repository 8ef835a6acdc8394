// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "gaussmap/map/grid.h"
#include "gaussmap/segments/segment_map.h"

namespace gaussmap::app {

/// What a picture shows in addition to the segments.
struct SegmentPicture {
  std::vector<Vector<2>> evidence;  ///< points [m], map frame
  /// A circle in which the map has more detail [m, map frame].
  struct Field {
    Vector<2> centre{0.0, 0.0};
    double radius = 0.0;
  };
  std::optional<Field> field;
  std::vector<Vector<2>> path;   ///< positions of an observer [m], map frame
  std::optional<Box<2>> window;  ///< the part to draw [m], map frame; std::nullopt: everything
  bool beside = false;           ///< true: the evidence is drawn beside the segments, false: under them
};

/// Writes an SVG picture with a scale bar. Each chain has one colour; its segments are drawn with their end points and
/// a pale band on the free side. Throws FileError if the file cannot be written.
void drawSegments(const SegmentMap& map, const SegmentPicture& picture, const std::filesystem::path& path);

}  // namespace gaussmap::app
