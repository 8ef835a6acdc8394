// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/sensor/range_image.h"
#include "gaussmap/sensor/visibility.h"

namespace gaussmap::detail {

/// Answers for whole balls of space what visibilityOf() answers for a point, but never says more than it knows: Yguel
/// 2009, sec. 4.2. Built once per range image, which must stay as it is for as long as this lives.
class Culling {
 public:
  explicit Culling(const RangeImage& image, const VisibilityOptions& options = {});

  /// False only if no point of the ball (centre [m, sensor frame], radius [m]) is PassedThrough: all of it is out of
  /// view, farther than all returns, or behind what the sensor saw.
  bool mayPassThrough(const Eigen::Vector3d& centre, double radius) const;

 private:
  struct Level {
    int rows = 0, columns = 0;
    std::vector<float> farthest;  // by rows: the largest of the nearest ranges, 0 where all is empty
  };
  float farthestIn(int first_row, int last_row, int first_column, int last_column) const;

  const RangeImage& image_;
  double tolerance_;
  std::vector<Level> levels_;  // finest first, each half as wide
};

/// What visitVisible() did.
struct VisitCounts {
  std::size_t tested = 0;   ///< cells of the coarser scales that were looked at
  std::size_t visited = 0;  ///< cells of the finest scale handed on
};

/// Hands every finest cell that may be passed through to visit(cell). From the coarsest scale down: nothing under a
/// cell is looked at that is out of view, out of reach or hidden. The finest cells themselves are not tested:
/// visibilityOf() answers for them at the same price.
///
/// `cells` gives scales(), rootCount(), centre(cell, scale) [m, map frame], radius(scale) [m], and
/// forChildren(cell, scale, body), which calls body(child) for the cells of scale - 1 under it.
template <typename Cells, typename Visit>
VisitCounts visitVisible(const Cells& cells, const Culling& culling, const Pose& sensor, const Visit& visit) {
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
    if (culling.mayPassThrough(centre, cells.radius(scale)))
      cells.forChildren(cell, scale, [&](std::size_t child) { self(self, child, scale - 1); });
  };
  for (std::size_t root = 0; root < cells.rootCount(); ++root) descend(descend, root, cells.scales() - 1);
  return counts;
}

}  // namespace gaussmap::detail
