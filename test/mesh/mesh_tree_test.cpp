// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/mesh_tree.h"

#include <gtest/gtest.h>

#include "mesh/mesh_pieces.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::oneTriangle;
using test::randomMesh;
using test::randomPoint;

TEST(MeshTree, MeetsATriangleFromBothSidesAndMissesBesideIt) {
  const MeshTree tree(oneTriangle());
  EXPECT_EQ(tree.intersect({1, 1, 5}, {0, 0, -1})->range, 5.0);
  EXPECT_EQ(tree.intersect({1, 1, -2}, {0, 0, 1})->range, 2.0);
  EXPECT_NEAR(tree.intersect({1, 0.5, 2}, {0.6, 0, -0.8})->range, 2.5, 1e-12);  // at (2.5, 0.5)
  EXPECT_FALSE(tree.intersect({1, 1, 5}, {0, 0, 1}));                           // the other way
  EXPECT_FALSE(tree.intersect({3, 2, 5}, {0, 0, -1}));                          // beyond the long side
  EXPECT_FALSE(tree.intersect({-0.1, 1, 5}, {0, 0, -1}));
  EXPECT_FALSE(tree.intersect({-1, 1, 0}, {1, 0, 0}));  // within its plane
  EXPECT_FALSE(tree.intersect({1, 1, 0}, {0, 0, 1}));   // starts on it
}

TEST(MeshTree, SeesNoFartherThanAskedTo) {
  const MeshTree tree(oneTriangle());
  EXPECT_TRUE(tree.intersect({1, 1, 5}, {0, 0, -1}, 5.0));
  EXPECT_FALSE(tree.intersect({1, 1, 5}, {0, 0, -1}, 4.999));
}

TEST(MeshTree, LetsNoRayThroughBetweenTrianglesThatTouch) {  // a fan round (0, 0, 0), rays at its spokes and its hub
  TriangleMesh mesh{{{0, 0, 0}}, {}};
  constexpr std::uint32_t kSpokes = 48;
  for (std::uint32_t i = 0; i < kSpokes; ++i) {
    const double angle = 2.0 * std::acos(-1.0) * i / kSpokes;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.1 * std::sin(3 * angle));
    mesh.triangles.push_back({0, i + 1, (i + 1) % kSpokes + 1});
  }
  const MeshTree tree(mesh);
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d target = random.uniform() * 0.99 * mesh.vertices[1 + random.below(kSpokes)];
    const Eigen::Vector3d origin(0.2 * random.normal(), 0.2 * random.normal(), 2.0 + random.uniform());
    ASSERT_TRUE(tree.intersect(origin, (target - origin).normalized())) << i;
  }
}

TEST(MeshTree, FindsTheSameHitsAsTryingAllTriangles) {
  for (const std::size_t triangles : {1u, 2u, 5u, 40u, 1000u}) {
    const TriangleMesh mesh = randomMesh(triangles, triangles);
    const MeshTree tree(mesh);
    Random random(8);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d origin = randomPoint(random, 6.0);
      Eigen::Vector3d direction = randomPoint(random, 1.0).normalized();
      if (i % 2 == 0)
        direction =
            (mesh.vertices[random.below(mesh.vertices.size())] + randomPoint(random, 0.3) - origin).normalized();
      if (i % 7 == 0) direction = Eigen::Vector3d::Unit(i % 3);  // along an axis: infinite inverses
      const test::SlowHit slow = test::slowHit(mesh, origin, direction);
      const std::optional<MeshHit> hit = tree.intersect(origin, direction);
      if (slow.edge < 1e-9 && std::isfinite(slow.range)) continue;
      ASSERT_EQ(hit.has_value(), std::isfinite(slow.range));
      if (!hit) continue;
      ++hits;
      ASSERT_NEAR(hit->range, slow.range, 1e-9 * (1.0 + slow.range));
      TriangleMesh alone{mesh.vertices, {mesh.triangles[hit->triangle]}};
      ASSERT_LT(test::slowDistance(alone, origin + hit->range * direction), 1e-9);
      ASSERT_FALSE(tree.intersect(origin, direction, hit->range * (1.0 - 1e-12)));
    }
    EXPECT_GT(hits, triangles < 1000 ? 10 : 1000) << triangles;
  }
}

TEST(MeshTree, FindsTheSameNearestPointAsTryingAllTriangles) {
  for (const std::size_t triangles : {1u, 2u, 5u, 40u, 1000u}) {
    const TriangleMesh mesh = randomMesh(triangles + 1, triangles);
    const MeshTree tree(mesh);
    Random random(9);
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d point = randomPoint(random, 6.0);
      const std::optional<MeshFoot> foot = tree.nearest(point);
      ASSERT_TRUE(foot);
      ASSERT_NEAR(foot->distance, test::slowDistance(mesh, point), 1e-11);
      ASSERT_NEAR((foot->point - point).norm(), foot->distance, 1e-11);
      ASSERT_LT(test::slowDistance({mesh.vertices, {mesh.triangles[foot->triangle]}}, foot->point), 1e-11);
    }
  }
}

TEST(MeshTree, IsExactFarFromTheOrigin) {  // earth-centred coordinates resolve a nanometre
  const Eigen::Vector3d far(4e6, 5e5, 5e6);
  const TriangleMesh mesh = randomMesh(2, 300, far);
  const MeshTree tree(mesh);
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d point = far + randomPoint(random, 6.0);
    ASSERT_NEAR(tree.nearest(point)->distance, test::slowDistance(mesh, point), 1e-8);
  }
}

TEST(MeshTree, TakesAnyMesh) {
  const MeshTree empty{TriangleMesh()};
  EXPECT_FALSE(empty.intersect({0, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(empty.nearest({0, 0, 0}));

  TriangleMesh heap = oneTriangle();
  heap.triangles.assign(50000, heap.triangles[0]);
  const MeshTree same(heap);
  EXPECT_EQ(same.intersect({1, 1, 5}, {0, 0, -1})->triangle, 0u);
  EXPECT_EQ(same.nearest({1, 1, 5})->triangle, 0u);

  const MeshTree point({{{1, 2, 3}}, {{0, 0, 0}}});
  EXPECT_FALSE(point.intersect({1, 2, 0}, {0, 0, 1}));
  EXPECT_EQ(point.nearest({1, 2, 0})->distance, 3.0);
}

TEST(MeshTree, TakesTrianglesOfAllSizes) {  // each ten times as far as the one before: the cheapest cut takes off one
  const auto size = [](std::uint32_t i) { return std::pow(10.0, double(i) - 300.0); };
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 370; ++i) {
    mesh.vertices.insert(mesh.vertices.end(), {{size(i), 0, 0}, {size(i), size(i), 0}, {size(i), 0, size(i)}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const MeshTree tree(mesh);
  for (std::uint32_t i = 240; i < 370; i += 9) {
    EXPECT_EQ(tree.nearest({size(i), 0.1 * size(i), 0.1 * size(i)})->triangle, i);
    EXPECT_EQ(tree.intersect({0.99 * size(i), 0.1 * size(i), 0.1 * size(i)}, {1, 0, 0})->triangle, i);
  }
  EXPECT_TRUE(tree.intersect({0, 0, 0}, Eigen::Vector3d(1, 0.1, 0.1).normalized()));  // through all their boxes
}

TEST(MeshTree, AnswersNothingToPointsThatAreNone) {
  const MeshTree tree(oneTriangle());
  EXPECT_FALSE(tree.nearest({std::nan(""), 0, 0}));
  EXPECT_FALSE(tree.nearest({1e200, 0, 0}));
  EXPECT_FALSE(tree.intersect({std::nan(""), 0, 0}, {0, 0, 1}));
}

TEST(MeshTree, RefusesAMeshWithAFault) {
  EXPECT_THROW(MeshTree({{}, {{0, 1, 2}}}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
