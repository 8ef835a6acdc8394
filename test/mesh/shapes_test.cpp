// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaussmap/core/random.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_measures.h"
#include "simulation/scene.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::isClosed;
using test::volume;

const double kPi = std::acos(-1.0);

TEST(MeshShapes, AreClosedAndLookOutwards) {
  const TriangleMesh box = boxMesh({1, 2, 3}, {2, 4, 6});
  EXPECT_TRUE(isClosed(box));
  EXPECT_NEAR(volume(box), 6.0, 1e-12);
  EXPECT_NEAR(surfaceArea(box), 22.0, 1e-12);

  const TriangleMesh drum = cylinderMesh({{1, 2, 3}, {0, 3, 4}, 2.0}, 360, CylinderEnds::Closed);
  EXPECT_TRUE(isClosed(drum));
  EXPECT_NEAR(volume(drum), kPi * 4.0 * 5.0, 0.01);

  const TriangleMesh egg = ellipsoidMesh({1, 2, 3}, {1, 2, 3}, 360);
  EXPECT_TRUE(isClosed(egg));
  EXPECT_NEAR(volume(egg), 4.0 / 3.0 * kPi * 6.0, 0.01);
  EXPECT_TRUE(isClosed(ellipsoidMesh({0, 0, 0}, {1, 1, 1}, 3)));

  const TriangleMesh wedge = profileMesh({{0, 0}, {2, 0.5}, {3, 0.5}}, 0.0, -1, 3);
  EXPECT_NEAR(volume(wedge), 4.0 * (0.5 + 0.5), 1e-12);
  EXPECT_TRUE(isClosed(profileMesh({{0, 1}, {2, 2}, {3, 1}}, 0.0, -1, 3)));
}

TEST(MeshShapes, HaveTheirCornersOnTheTrueShape) {
  const Cylinder pipe{{1, 2, 3}, {2, -1, 2}, 0.7};
  for (const Eigen::Vector3d& vertex : cylinderMesh(pipe, 17).vertices) EXPECT_LT(distance(vertex, pipe), 1e-12);
  for (const Eigen::Vector3d& vertex : ellipsoidMesh({1, 0, 0}, {1, 2, 3}, 17).vertices)
    EXPECT_NEAR((vertex - Eigen::Vector3d(1, 0, 0)).cwiseQuotient(Eigen::Vector3d(1, 2, 3)).norm(), 1.0, 1e-12);
  const Rectangle door{{2, 0, 0}, {0, 1, 0}, {0, 0, 2}};
  EXPECT_DOUBLE_EQ(surfaceArea(rectangleMesh(door)), 2.0);
  for (const Eigen::Vector3d& vertex : rectangleMesh(door).vertices) EXPECT_EQ(distance(vertex, door), 0.0);
}

TEST(MeshShapes, RefuseTooFewFacets) {
  EXPECT_THROW(cylinderMesh({{0, 0, 0}, {0, 0, 1}, 1}, 2), std::invalid_argument);
  EXPECT_THROW(ellipsoidMesh({0, 0, 0}, {1, 1, 1}, 2), std::invalid_argument);
  EXPECT_THROW(profileMesh({{0, 0}}, 0, 0, 1), std::invalid_argument);
}

TEST(Triangulate, StaysAsNearToTheSceneAsAsked) {
  const Scene scene = demoScene();
  for (const double deviation : {1e-2, 1e-3, 1e-5}) {
    const TriangleMesh mesh = triangulate(scene, deviation);
    double farthest = 0.0;
    for (const Eigen::Vector3d& point : sampleSurface(mesh, 20000))
      farthest = std::max(farthest, scene.distance(point));
    EXPECT_LT(farthest, deviation * (1.0 + 1e-9));
    const MeshDistance truth(mesh);
    for (const Eigen::Vector3d& point : sampleSurface(scene, 0.2))
      ASSERT_LT(truth.distance(point), deviation * (1.0 + 1e-9));
  }
  EXPECT_THROW(triangulate(scene, 0.0), std::invalid_argument);
  EXPECT_THROW(triangulate({{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}, {}}), std::invalid_argument);
}

TEST(Triangulate, IsMetByRaysWhereTheSceneIs) {  // two ways to cast a ray: exact primitives and triangles
  const Scene scene = demoScene();
  const MeshTree tree(triangulate(scene, 1e-6));
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
    const Ray ray{{random.normal(), random.normal(), 1.0 + random.uniform()}, direction.normalized()};
    const std::optional<double> range = scene.intersect(ray);
    const std::optional<MeshHit> hit = tree.intersect(ray.origin, ray.direction);
    ASSERT_EQ(hit.has_value(), range.has_value());
    if (!hit) continue;
    ++hits;
    ASSERT_NEAR(hit->range, *range, 2e-4);  // 1e-6 m, but at a grazing angle on the pole
  }
  EXPECT_GT(hits, 2000);
}

}  // namespace
}  // namespace gaussmap
