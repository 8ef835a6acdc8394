// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "gaussmap/core/pose.h"
#include "mesh/shapes.h"

namespace gaussmap {

using detail::Cylinder;
using detail::Rectangle;

/// A half-line; range r along it is the point origin + r direction.
struct Ray {
  Eigen::Vector3d origin;     ///< [m]
  Eigen::Vector3d direction;  ///< unit length
};

/// Range [m], > 0, at which a ray meets a surface first, from either side; nothing if it does not.
/// A ray that runs within a flat patch does not meet it.
std::optional<double> intersect(const Ray& ray, const Rectangle& rectangle);
std::optional<double> intersect(const Ray& ray, const Cylinder& cylinder);

/// Distance [m] from a point to the nearest point of a surface.
double distance(const Eigen::Vector3d& point, const Rectangle& rectangle);
double distance(const Eigen::Vector3d& point, const Cylinder& cylinder);

/// A world known exactly: what simulated scans and maps made of them are measured against.
struct Scene {
  std::vector<Rectangle> rectangles;
  std::vector<Cylinder> cylinders;

  /// Distance [m] from a point to the nearest surface; infinity in an empty scene.
  double distance(const Eigen::Vector3d& point) const;
  /// Range [m] at which a ray meets the first surface, nothing if it meets none.
  std::optional<double> intersect(const Ray& ray) const;
  /// The scene moved by R p + t.
  Scene transformed(const Pose& pose) const;
};

/// Throws std::invalid_argument, naming the primitive, if one is not finite, has no extent, or has slanting edges.
void checkScene(const Scene& scene);

/// Regular points on all surfaces [m], in number proportional to area: each stands in the middle of an equal tile at
/// most `spacing` wide, so that no point of the scene is farther than spacing / sqrt(2) from one of them.
/// Throws std::invalid_argument unless spacing > 0, or if that would be more than 10^9 points.
std::vector<Eigen::Vector3d> sampleSurface(const Scene& scene, double spacing);

/// All surfaces of a scene. A facet is nowhere farther than `deviation` [m] from its cylinder.
/// Throws std::invalid_argument on unusable scenes (see checkScene()), or unless deviation > 0.
TriangleMesh triangulate(const Scene& scene, double deviation = 1e-4);

/// A floor of 20 m x 12 m, two walls of 4 m height that meet at a right angle, a pole of 0.3 m diameter and 4 m
/// height; turned by 17 degrees and shifted, so that no wall is aligned with the cells of a map and no surface lies
/// on a border between cells.
Scene demoScene();

/// Five poses of a sensor 1.8 m above that floor, driving along both walls past the pole (slightly rolling and
/// pitching, as vehicles do).
std::vector<Pose> demoTrajectory();

}  // namespace gaussmap
