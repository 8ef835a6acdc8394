// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/sensor/range_image.h"
#include "gaussmap/sensor/visibility.h"

namespace gaussmap::detail {

/// Tests balls of space as visibilityOf() tests points, but conservatively, Yguel 2009, sec. 4.2. It is built once per
/// range image, and keeps a reference to it. The image must not change while this object exists.
class Culling {
 public:
  explicit Culling(const RangeImage& image, const VisibilityOptions& options = {});

  /// Returns false only if no point of the ball (centre [m, sensor frame], radius [m]) is Visibility::PassedThrough.
  /// The ball is then out of view, farther than all returns, or behind the surfaces that the sensor saw.
  bool mayPassThrough(const Eigen::Vector3d& centre, double radius) const;
  /// Returns false only if no point of the ball is Visibility::AtSurface or Visibility::PassedThrough: the whole ball
  /// is out of view, or all beams towards it end before it.
  bool maySee(const Eigen::Vector3d& centre, double radius) const;

 private:
  struct Level {
    int rows = 0, columns = 0;
    std::vector<float> farthest;  // row by row: maximum of PixelRanges::nearest [m], 0 if all are empty
  };
  /// Returns the largest of the nearest ranges of the pixels that can see a ball, and of their neighbours [m]; 0 if the
  /// ball is out of view or these pixels are empty.
  double farthestAround(const Eigen::Vector3d& centre, double radius) const;
  float farthestIn(int first_row, int last_row, int first_column, int last_column) const;

  const RangeImage& image_;
  double tolerance_;
  std::vector<Level> levels_;  // finest first, each with half the rows and columns of the one before
};

/// Numbers of cells in visitVisible().
struct VisitCounts {
  std::size_t tested = 0;   ///< cells of the coarser scales that were tested
  std::size_t visited = 0;  ///< cells of the finest scale that visit() was called for
};

/// Calls visit(cell) for every finest cell under coarse cells that pass a test. It descends from the coarsest scale,
/// and skips everything under a cell for which may(centre, radius) returns false (see Culling). It does not test the
/// finest cells themselves, because a call of visibilityOf() costs the same.
///
/// `cells` provides scales(), rootCount(), centre(cell, scale) [m, map frame], radius(scale) [m], and
/// forChildren(cell, scale, body), which calls body(child) for the cells of scale - 1 under it.
template <typename Cells, typename May, typename Visit>
VisitCounts visitCells(const Cells& cells, const Pose& sensor, const May& may, const Visit& visit) {
  VisitCounts counts;
  const Eigen::Matrix3d to_sensor = sensor.rotation.toRotationMatrix().transpose();
  const auto descend = [&](const auto& self, std::size_t cell, int scale) -> void {
    if (scale == 0) {
      ++counts.visited;
      visit(cell);
      return;
    }
    ++counts.tested;
    const Eigen::Vector3d centre = to_sensor * (cells.centre(cell, scale) - sensor.translation);
    if (may(centre, cells.radius(scale)))
      cells.forChildren(cell, scale, [&](std::size_t child) { self(self, child, scale - 1); });
  };
  for (std::size_t root = 0; root < cells.rootCount(); ++root) descend(descend, root, cells.scales() - 1);
  return counts;
}

/// Calls visit(cell) for every finest cell that beams may have passed through, see visitCells().
template <typename Cells, typename Visit>
VisitCounts visitVisible(const Cells& cells, const Culling& culling, const Pose& sensor, const Visit& visit) {
  const auto may = [&](const Eigen::Vector3d& centre, double radius) { return culling.mayPassThrough(centre, radius); };
  return visitCells(cells, sensor, may, visit);
}

}  // namespace gaussmap::detail
