// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "gaussmap/segments/segment_map.h"
#include "mesh/mesh_tree.h"

namespace gaussmap::detail {

/// Finds the line segment that is nearest to a point, or that a ray hits first. The segments are vertical walls in a
/// MeshTree; queries are at half the height of the walls.
class SegmentTree {
 public:
  struct Hit {
    double range = 0.0;       ///< [m], > 0
    std::size_t segment = 0;  ///< index
  };

  /// Throws std::invalid_argument if an end point is not finite.
  explicit SegmentTree(const std::vector<Segment>& segments) : tree_(asWalls(segments)) {}

  /// Returns the distance to the nearest segment [m]; infinity if there is none.
  double distance(const Vector<2>& point) const {
    const auto foot = tree_.nearest({point.x(), point.y(), 0.0});
    return foot ? foot->distance : std::numeric_limits<double>::infinity();
  }

  /// Returns the first hit of the ray from `origin` in the direction `bearing` [rad, map frame], from either side;
  /// std::nullopt if there is none.
  std::optional<Hit> intersect(const Vector<2>& origin, double bearing) const {
    const auto hit = tree_.intersect({origin.x(), origin.y(), 0.0}, {std::cos(bearing), std::sin(bearing), 0.0});
    if (!hit) return std::nullopt;
    return Hit{hit->range, hit->triangle / 2};
  }

 private:
  /// Returns two triangles per segment, in the order of the segments.
  static TriangleMesh asWalls(const std::vector<Segment>& segments) {
    TriangleMesh mesh;
    for (const Segment& segment : segments) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const double height : {-1.0, 1.0})
        for (const Vector<2>& point : {segment.start, segment.end})
          mesh.vertices.emplace_back(point.x(), point.y(), height);
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first + 1, first + 3, first + 2});
    }
    return mesh;
  }

  MeshTree tree_;
};

}  // namespace gaussmap::detail
