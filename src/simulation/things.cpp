// SPDX-License-Identifier: BSD-3-Clause
// Furniture, plants, vehicles and people of the built-in worlds.
#include <cmath>

#include "gaussmap/core/gaussian.h"
#include "mesh/shapes.h"
#include "simulation/worlds.h"

namespace gaussmap::simulation {
using namespace detail;

namespace {

TriangleMesh together(const std::vector<TriangleMesh>& parts) {
  TriangleMesh mesh;
  for (const TriangleMesh& part : parts) append(mesh, part);
  return mesh;
}

TriangleMesh rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) {
  return cylinderMesh({from, to - from, radius}, 16, CylinderEnds::Closed);
}

TriangleMesh vehicle(const std::vector<Eigen::Vector2d>& profile, double width, double axle) {
  constexpr double kWheel = 0.31, kTyre = 0.2, kClearance = 0.22;
  TriangleMesh mesh = profileMesh(profile, kClearance, -width / 2, width / 2);
  for (const double x : {-axle, axle})
    for (const double y : {-width / 2 + 0.02, width / 2 - 0.02 - kTyre})
      append(mesh, cylinderMesh({{x, y, kWheel}, {0, kTyre, 0}, kWheel}, 24, CylinderEnds::Closed));
  return mesh;
}

}  // namespace

TriangleMesh placed(const TriangleMesh& mesh, double x, double y, double z, double yaw) {
  return transformed(mesh, {{x, y, z}, turned(yaw, 0.0, 0.0)});
}

TriangleMesh carMesh() {
  return vehicle(
      {{-2.2, 0.55}, {-2.15, 0.85}, {-1.6, 0.97}, {-1.05, 1.42}, {0.45, 1.46}, {1.2, 0.98}, {2.05, 0.84}, {2.2, 0.5}},
      1.76, 1.35);
}

TriangleMesh vanMesh() {
  return vehicle({{-2.5, 0.5}, {-2.45, 1.95}, {-2.3, 2.05}, {1.1, 2.05}, {1.75, 1.2}, {2.4, 1.0}, {2.5, 0.5}}, 1.9,
                 1.6);
}

TriangleMesh pedestrianMesh() {
  return together(
      {rod({0.22, -0.1, 0.03}, {0.0, -0.1, 0.85}, 0.08), rod({-0.22, 0.1, 0.03}, {0.0, 0.1, 0.85}, 0.08),
       ellipsoidMesh({0, 0, 1.13}, {0.16, 0.23, 0.36}, 24), ellipsoidMesh({0.02, 0, 1.63}, {0.11, 0.1, 0.13}, 16),
       rod({0.02, -0.27, 1.35}, {-0.16, -0.3, 0.85}, 0.05), rod({0.02, 0.27, 1.35}, {0.2, 0.3, 0.87}, 0.05)});
}

TriangleMesh treeMesh(double trunk, double crown, unsigned seed) {
  constexpr double kRough = 0.1;  // share of the radius
  TriangleMesh leaves = ellipsoidMesh({0, 0, 0}, {crown, crown, 0.85 * crown}, 32);
  Random random(seed);
  for (Eigen::Vector3d& vertex : leaves.vertices) vertex *= 1.0 + kRough * (2.0 * random.uniform() - 1.0);
  return together({cylinderMesh({{0, 0, 0}, {0, 0, trunk + 0.3 * crown}, 0.05 + 0.04 * trunk}, 16),
                   placed(leaves, 0, 0, trunk + 0.75 * crown, 37.0 * seed)});
}

TriangleMesh lampMesh() {
  return together({rod({0, 0, 0}, {0, 0, 6.5}, 0.08), rod({0, 0, 6.4}, {1.5, 0, 6.6}, 0.04),
                   boxMesh({1.3, -0.12, 6.5}, {1.9, 0.12, 6.62})});
}

TriangleMesh fenceMesh(double length) {
  constexpr double kHeight = 1.1, kSlat = 0.09, kPitch = 0.18, kPostEvery = 2.0;
  TriangleMesh mesh =
      together({boxMesh({0, 0.01, 0.25}, {length, 0.05, 0.33}), boxMesh({0, 0.01, 0.8}, {length, 0.05, 0.88})});
  for (int i = 0; i * kPitch + kSlat <= length; ++i)
    append(mesh, boxMesh({i * kPitch, -0.012, 0.08}, {i * kPitch + kSlat, 0.01, kHeight}));
  for (int i = 0; i * kPostEvery <= length; ++i)
    append(mesh, boxMesh({i * kPostEvery - 0.04, 0.05, 0}, {i * kPostEvery + 0.04, 0.13, kHeight + 0.08}));
  return mesh;
}

TriangleMesh benchMesh() {
  return together({boxMesh({-0.25, -0.9, 0.42}, {0.2, 0.9, 0.47}), boxMesh({-0.3, -0.9, 0.47}, {-0.25, 0.9, 0.9}),
                   boxMesh({-0.2, -0.8, 0}, {0.15, -0.7, 0.42}), boxMesh({-0.2, 0.7, 0}, {0.15, 0.8, 0.42})});
}

TriangleMesh shelterMesh() {
  return together({boxMesh({-0.75, -2.0, 2.35}, {0.85, 2.0, 2.45}), boxMesh({-0.7, -1.9, 0.15}, {-0.66, 1.9, 2.35}),
                   boxMesh({-0.66, -1.9, 0.15}, {0.3, -1.86, 2.2}), rod({0.6, -1.85, 0}, {0.6, -1.85, 2.35}, 0.04),
                   rod({0.6, 1.85, 0}, {0.6, 1.85, 2.35}, 0.04), boxMesh({-0.5, -1.0, 0.45}, {-0.1, 1.2, 0.5})});
}

TriangleMesh tableMesh(double length, double width) {
  const double x = length / 2, y = width / 2;
  TriangleMesh mesh = boxMesh({-x, -y, 0.71}, {x, y, 0.75});
  for (const double sx : {-1.0, 1.0})
    for (const double sy : {-1.0, 1.0}) {
      const Eigen::Vector3d foot(sx * (x - 0.06), sy * (y - 0.06), 0.0);
      append(mesh, boxMesh(foot - Eigen::Vector3d(0.025, 0.025, 0), foot + Eigen::Vector3d(0.025, 0.025, 0.71)));
    }
  return mesh;
}

TriangleMesh chairMesh() {
  TriangleMesh mesh =
      together({boxMesh({-0.22, -0.22, 0.43}, {0.22, 0.22, 0.46}), boxMesh({-0.22, -0.22, 0.46}, {-0.18, 0.22, 0.9})});
  for (const double x : {-0.2, 0.17})
    for (const double y : {-0.2, 0.17}) append(mesh, boxMesh({x, y, 0}, {x + 0.03, y + 0.03, 0.43}));
  return mesh;
}

TriangleMesh shelfMesh(double length) {
  TriangleMesh mesh = boxMesh({-0.02, 0, 0}, {0, length, 2.0});  // the back; the boards are in front of it
  for (int board = 0; board <= 5; ++board) {
    const double z = 0.05 + 0.38 * board;
    append(mesh, boxMesh({0, 0, z}, {0.32, length, z + 0.03}));
  }
  for (const double y : {0.0, length - 0.03}) append(mesh, boxMesh({0, y, 0}, {0.33, y + 0.03, 2.02}));
  return mesh;
}

TriangleMesh sofaMesh() {
  return together({boxMesh({-0.4, -1.0, 0.05}, {0.45, 1.0, 0.42}), boxMesh({-0.4, -1.0, 0.42}, {-0.15, 1.0, 0.85}),
                   boxMesh({-0.4, -1.2, 0.05}, {0.45, -1.0, 0.6}), boxMesh({-0.4, 1.0, 0.05}, {0.45, 1.2, 0.6})});
}

}  // namespace gaussmap::simulation
