// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/blocks.h"

#include <gtest/gtest.h>

#include "mesh/mesh_measures.h"
#include "mesh/mesh_tree.h"

namespace gaussmap::simulation {
using namespace detail;

namespace {

TEST(Rooms, EncloseTheirAir) {  // two rooms and a lower door between them
  const TriangleMesh mesh = roomsMesh({{0, 0, 4, 3, 3.0}, {4.2, 0, 8, 3, 2.5}, {4, 1, 4.2, 2, 2.0}});
  EXPECT_NEAR(test::volume(mesh), -(4 * 3 * 3.0 + 3.8 * 3 * 2.5 + 0.2 * 1 * 2.0), 1e-9);  // seen from within
  const MeshTree tree(mesh);
  EXPECT_NEAR(tree.intersect({1, 1.5, 1}, {1, 0, 0})->range, 7.0, 1e-12);    // through the door to the far wall
  EXPECT_NEAR(tree.intersect({1, 1.5, 2.2}, {1, 0, 0})->range, 3.0, 1e-12);  // the lintel
  EXPECT_NEAR(tree.intersect({4.1, 1.5, 1}, {0, 0, 1})->range, 1.0, 1e-12);
  EXPECT_NEAR(tree.intersect({1, 0.5, 1}, {1, 0, 0})->range, 3.0, 1e-12);
}

TEST(Rooms, HaveNoSurfaceInsideWhatIsOne) {  // three blocks, one of them over the others: a plain box of 12 triangles
  const TriangleMesh mesh = roomsMesh({{0, 0, 2, 3, 3.0}, {2, 0, 4, 3, 3.0}, {1, 1, 3, 2, 3.0}});
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(surfaceArea(mesh), 2 * (4 * 3 + 3 * 3 + 4 * 3), 1e-12);
}

TEST(Terrace, HasTopsAndStepsButNoRim) {
  const TriangleMesh mesh = terraceMesh({{0, 0, 4, 4, 1.0}, {1, 1, 2, 2, 3.0}, {2, 2, 3, 3, -1.0}});
  EXPECT_NEAR(surfaceArea(mesh), 16.0 + 4 * 2.0 + 4 * 2.0, 1e-12);
  const MeshTree tree(mesh);
  EXPECT_EQ(tree.intersect({1.5, 1.5, 9}, {0, 0, -1})->range, 6.0);
  EXPECT_EQ(tree.intersect({2.5, 2.5, 9}, {0, 0, -1})->range, 10.0);
  EXPECT_EQ(tree.intersect({0.5, 0.5, 9}, {0, 0, -1})->range, 8.0);
  EXPECT_EQ(tree.intersect({0.25, 1.5, 2}, {1, 0, 0})->range, 0.75);
  EXPECT_FALSE(tree.intersect({-1, 1.5, 0.5}, {1, 0, 0}, 2.9));  // below the rim, above the pit
}

TEST(Terrace, LooksToTheOpenSide) {
  const TriangleMesh mesh = terraceMesh({{0, 0, 4, 4, 0.0}, {1, 1, 2, 2, 3.0}});
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
    const Eigen::Vector3d normal = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    if (std::abs(normal.z()) > 0.5) {
      EXPECT_GT(normal.z(), 0.0);
    } else {
      EXPECT_GT(normal.dot(middle - Eigen::Vector3d(1.5, 1.5, 1.5)), 0.0);
    }
  }
}

TEST(Outline, HasFreeSpaceOnItsLeft) {  // a room with a column in it
  const std::vector<Step> steps = outline({{0, 0, 4, 3, 1}, {1, 1, 2, 2, 0}});
  EXPECT_EQ(steps.size(), 8u);
  double length = 0.0, area = 0.0;
  for (const Step& step : steps) {
    length += (step.to - step.from).norm();
    area +=
        0.5 * (step.from.x() * step.to.y() - step.to.x() * step.from.y());  // counter-clockwise round the free space
  }
  EXPECT_DOUBLE_EQ(length, 14.0 + 4.0);
  EXPECT_DOUBLE_EQ(area, 12.0 - 1.0);
}

TEST(Outline, JoinsWhatIsOneWall) {
  EXPECT_EQ(outline({{0, 0, 1, 1, 1}, {1, 0, 2, 1, 1}, {2, 0, 3, 1, 5}}).size(), 4u);
  EXPECT_TRUE(outline({}).empty());
  EXPECT_TRUE(terraceMesh({}).triangles.empty());
}

}  // namespace
}  // namespace gaussmap::simulation
