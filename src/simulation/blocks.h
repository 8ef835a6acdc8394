// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/mesh/triangle_mesh.h"

// Rooms, streets and building fronts are made of rectangles at different levels: painted one over the other on a plane,
// then turned into exactly the surfaces that can be seen, without any hidden within walls.
namespace gaussmap::simulation {

struct Block {
  double x0, y0, x1, y1;  ///< [m], x0 < x1, y0 < y1
  double level;           ///< height, depth or ceiling [m]
};

/// A step between two levels, above the line between two points of the plane.
struct Step {
  Eigen::Vector2d from, to;  ///< the open side is to the left of this direction
  double low, high;          ///< the two levels [m]
};

/// Blocks from above: tops at their levels and the steps between them; later ones lie over earlier ones. Nothing
/// where no block is.
TriangleMesh terraceMesh(const std::vector<Block>& blocks);

/// Blocks as free space, 0 up to the level: floor, ceiling, and walls all round. Level 0 is solid.
TriangleMesh roomsMesh(const std::vector<Block>& blocks);

/// The walls round free space (level > 0): straight pieces as long as can be, free space on the left.
std::vector<Step> outline(std::vector<Block> blocks);

/// Vertical faces over lines, visible from their left.
TriangleMesh wallsMesh(const std::vector<Step>& steps);

}  // namespace gaussmap::simulation
