// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/mesh/triangle_mesh.h"

// Rooms, streets and building fronts are made of rectangles at different levels. They are painted one over the other on
// a plane, then converted to the visible surfaces only. No surface is hidden within a wall.
namespace gaussmap::simulation {

struct Block {
  double x0, y0, x1, y1;  ///< [m], x0 < x1, y0 < y1
  double level;           ///< height, depth or ceiling [m]
};

/// A vertical step between two levels, above the line between two points of the plane.
struct Step {
  Eigen::Vector2d from, to;  ///< the open side is to the left of this direction
  double low, high;          ///< the two levels [m]
};

/// Returns the surface of blocks as seen from above: their tops at their levels, and the steps between them. Later
/// blocks cover earlier ones. Where there is no block, there is no surface.
TriangleMesh terraceMesh(const std::vector<Block>& blocks);

/// Returns the surfaces around blocks of free space from height 0 up to their levels: floor, ceiling and all walls. A
/// block of level 0 is solid.
TriangleMesh roomsMesh(const std::vector<Block>& blocks);

/// Returns the walls around free space (level > 0) as straight pieces of maximum length, free space on their left.
std::vector<Step> outline(std::vector<Block> blocks);

/// Returns vertical faces above the lines, visible from their left.
TriangleMesh wallsMesh(const std::vector<Step>& steps);

}  // namespace gaussmap::simulation
