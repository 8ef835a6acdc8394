// SPDX-License-Identifier: BSD-3-Clause
// A hall of 18 m x 12 m, a corridor behind it, and two rooms on either side of the corridor.
#include "mesh/shapes.h"
#include "simulation/worlds.h"

namespace gaussmap::simulation {
using namespace detail;

namespace {

constexpr double kHall = 5.0, kCorridor = 2.7, kRoom = 3.0, kDoor = 2.1;  // heights [m]

TriangleMesh walls() {
  return roomsMesh({{0, 0, 18, 12, kHall},
                    {7, -0.9, 10.5, 0, 3.2},  // a niche
                    {2.5, 12, 4.5, 12.3, 4.2},
                    {8, 12, 10, 12.3, 4.2},
                    {13.5, 12, 15.5, 12.3, 4.2},
                    {18, 5.2, 18.2, 6.8, 2.3},  // the wide door
                    {18.2, 4.8, 32, 7.2, kCorridor},
                    {20, 7.2, 21, 7.4, kDoor},
                    {29, 7.2, 30, 7.4, kDoor},
                    {22, 4.6, 23, 4.8, kDoor},
                    {27, 4.6, 28, 4.8, kDoor},
                    {18.6, 7.4, 24.4, 12, kRoom},
                    {24.6, 7.4, 32, 12, kRoom},
                    {18.6, 0, 25, 4.6, kRoom},
                    {25.2, 0, 32, 4.6, kRoom}});
}

void furnishHall(TriangleMesh& mesh) {
  for (const double x : {5.0, 13.0})
    for (const double y : {4.0, 8.0}) append(mesh, cylinderMesh({{x, y, 0}, {0, 0, kHall}, 0.3}, 48));
  append(mesh, boxMesh({17.3, 0.0, 0}, {18, 1.8, 2.2}));  // a cupboard
  append(mesh, boxMesh({0, 5.2, 0}, {0.55, 7.6, 1.1}));   // a counter
  append(mesh, placed(sofaMesh(), 8.7, -0.4, 0, 90));
  append(mesh, placed(tableMesh(1.2, 0.7), 9.0, 4.0, 0, 12));
  append(mesh, placed(boxMesh({0, 0, 0}, {1.2, 0.8, 0.9}), 10.5, 8.2, 0, 31));  // crates
  append(mesh, placed(boxMesh({0, 0, 0.9}, {0.7, 0.6, 1.5}), 10.7, 8.4, 0, 40));
  for (const double x : {3.0, 9.0, 15.0}) append(mesh, ellipsoidMesh({x, 6, 3.9}, {0.3, 0.3, 0.2}, 24));  // lamps
}

void furnishRooms(TriangleMesh& mesh) {
  append(mesh, placed(tableMesh(1.6, 0.8), 23.3, 11.2, 0, 0));
  append(mesh, placed(chairMesh(), 23.2, 10.5, 0, 80));
  append(mesh, placed(shelfMesh(3.0), 18.62, 8.2, 0, 0));
  append(mesh, placed(tableMesh(2.4, 1.1), 27.2, 10.2, 0, 8));
  for (const double x : {26.5, 27.3, 28.1}) {
    append(mesh, placed(chairMesh(), x, 9.3, 0, 95));
    append(mesh, placed(chairMesh(), x + 0.1, 11.1, 0, -88));
  }
  append(mesh, placed(shelfMesh(2.0), 19.2, 0.02, 0, 90));
  append(mesh, placed(shelfMesh(1.6), 24.98, 2.5, 0, 180));
  append(mesh, placed(sofaMesh(), 31.4, 2.3, 0, 180));
  append(mesh, placed(tableMesh(1.0, 0.6), 29.9, 2.2, 0, 75));
  append(mesh, boxMesh({25.2, 0, 0}, {26.2, 0.6, 1.9}));
  append(mesh, boxMesh({31.5, 4.85, 0}, {31.98, 6.2, 1.0}));  // at the end of the corridor
}

}  // namespace

Pose hallPlacement() {
  return {{-11.4, -8.7, 0.04}, turned(17.0, 0.0, 0.0)};
}

TriangleMesh hallMesh() {
  TriangleMesh mesh = walls();
  furnishHall(mesh);
  furnishRooms(mesh);
  return mesh;
}

std::vector<Eigen::Vector2d> hallPath() {
  return {{2.5, 2.5},  {9, 1.8},    {15.5, 2.5}, {15.5, 9.5}, {9, 10.4},   {2.5, 9.2},  {2.5, 6.0},
          {9, 6.1},    {15, 6.0},   {19.2, 6.0}, {20.4, 6.2}, {20.5, 8.2}, {22.6, 9.4}, {20.2, 10.6},
          {20.4, 8.4}, {20.5, 6.4}, {21.4, 5.9}, {22.4, 5.8}, {22.5, 3.8}, {23.6, 2.0}, {20.8, 2.2},
          {22.4, 3.8}, {22.5, 5.6}, {25.5, 6.0}, {27.4, 5.9}, {27.5, 3.6}, {28.4, 2.0}, {26.6, 2.0},
          {27.4, 3.6}, {27.5, 5.6}, {29.4, 6.1}, {29.5, 8.2}, {30.6, 9.6}, {29.8, 11.2}};
}

}  // namespace gaussmap::simulation
