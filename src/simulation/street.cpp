// SPDX-License-Identifier: BSD-3-Clause
// A street of 150 m along x: the road from y = -5 to 5, kerbs, sidewalks, plane building fronts with corners from 8.5 m
// on; poles, trees with closed crowns, parked cars of two boxes, a fence.
#include <algorithm>

#include "mesh/shapes.h"
#include "simulation/worlds.h"

namespace gaussmap::simulation {
using namespace detail;

namespace {

constexpr double kStreetKerb = 0.12;  // height of the sidewalk [m]

/// Adds buildings with a front of 15 m each, and a gap after every fourth.
void addBuildings(TriangleMesh& mesh, double side) {
  for (int i = 0; i < 10; ++i) {
    const double x = -20 + 15.0 * i, width = i % 4 == 3 ? 12.0 : 15.0;
    const double front = side * (8.5 + 0.6 * ((3 * i) % 4));
    append(mesh, boxMesh({x, std::min(front, 20 * side), 0}, {x + width, std::max(front, 20 * side), 10.0 + i % 3}));
  }
}

/// Returns the places from `first` to the end of the street, `step` [m] apart.
std::vector<double> placesAlong(double first, double step) {
  std::vector<double> places;
  for (int k = 0; first + step * k < 130.0; ++k) places.push_back(first + step * k);
  return places;
}

void addTrees(TriangleMesh& mesh, double side) {
  for (const double x : placesAlong(-4 + 7 * side, 30)) {
    append(mesh, cylinderMesh({{x, 6.2 * side, kStreetKerb}, {0, 0, 3.4}, 0.16}, 16));
    append(mesh, ellipsoidMesh({x, 6.2 * side, 4.3}, {1.5, 1.5, 1.3}, 32));
  }
}

void addCars(TriangleMesh& mesh, double side) {
  for (const double x : placesAlong(3 + 6 * side, 25)) {
    append(mesh, boxMesh({x, 4 * side - 0.88, 0.25}, {x + 4.3, 4 * side + 0.88, 0.95}));
    append(mesh, boxMesh({x + 1.0, 4 * side - 0.75, 0.95}, {x + 3.4, 4 * side + 0.75, 1.45}));
  }
}

}  // namespace

Pose streetPlacement() {
  return {{-41.3, -27.8, 0.063}, turned(23.0, -0.6, 0.3)};
}

TriangleMesh streetMesh() {
  TriangleMesh mesh = rectangleMesh({{-20, -5, 0}, {150, 0, 0}, {0, 10, 0}});
  for (const double side : {-1.0, 1.0}) {
    append(mesh, rectangleMesh({{-20, 5 * side, 0}, {150, 0, 0}, {0, 0, kStreetKerb}}));
    append(mesh, rectangleMesh({{-20, 5 * side, kStreetKerb}, {150, 0, 0}, {0, 6 * side, 0}}));
    addBuildings(mesh, side);
    addTrees(mesh, side);
    addCars(mesh, side);
    for (const double x : placesAlong(-12 + 5 * side, 20))
      append(mesh, cylinderMesh({{x, 5.5 * side, kStreetKerb}, {0, 0, 6}, 0.1}, 16));
  }
  append(mesh, boxMesh({60, 7.0, kStreetKerb}, {90, 7.05, 1.2}));  // a fence
  return mesh;
}

std::vector<MovingObject> streetTraffic() {
  return {{placed(carMesh(), 118, 1.6, 0, 180), {-5.2, 0, 0}},               // towards the sensor, past it
          {placed(carMesh(), 55, 1.5, 0, 180), {-3.0, 0, 0}},                // towards the sensor, slower
          {placed(vanMesh(), 23, -1.5, 0, 0), {4.9, 0, 0}},                  // ahead of the sensor
          {placed(pedestrianMesh(), 30, 7.4, kStreetKerb, 0), {1.3, 0, 0}},  // along the left sidewalk
          {placed(pedestrianMesh(), 96, -4.5, 0, 90), {0, 0.45, 0}}};        // across the road
}

std::vector<Eigen::Vector2d> streetPath() {
  return {{8, -1.5}, {40, -1.2}, {70, -1.7}, {102, -1.4}};
}

}  // namespace gaussmap::simulation
