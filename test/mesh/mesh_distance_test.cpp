// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/mesh_distance.h"

#include <gtest/gtest.h>

#include "mesh/mesh_pieces.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::oneTriangle;
using test::randomMesh;

TEST(MeshDistance, IsToTheFaceAnEdgeOrACorner) {
  const MeshDistance mesh(oneTriangle());
  EXPECT_DOUBLE_EQ(mesh.distance({1, 1, 2}), 2.0);
  EXPECT_DOUBLE_EQ(mesh.distance({1, 1, -2}), 2.0);
  EXPECT_DOUBLE_EQ(mesh.distance({1, 1, 0}), 0.0);
  EXPECT_DOUBLE_EQ(mesh.distance({2, -3, 4}), 5.0);             // edge y = 0
  EXPECT_DOUBLE_EQ(mesh.distance({-1, -2, 2}), 3.0);            // corner (0, 0)
  EXPECT_DOUBLE_EQ(mesh.distance({7, 0, -4}), 5.0);             // corner (4, 0)
  EXPECT_NEAR(mesh.distance({2 + 3, 1.5 + 4, 0}), 5.0, 1e-12);  // long side, at its middle; (3, 4) is normal to it
  EXPECT_LT((mesh.nearest({5, 5.5, 0}).point - Eigen::Vector3d(2, 1.5, 0)).norm(), 1e-12);
}

TEST(MeshDistance, OfATriangleWithoutAreaIsToWhatIsLeftOfIt) {
  const TriangleMesh segment{{{0, 0, 0}, {4, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}, point{{{1, 1, 1}}, {{0, 0, 0}}};
  EXPECT_DOUBLE_EQ(MeshDistance(segment).distance({3, 3, 4}), 5.0);
  EXPECT_DOUBLE_EQ(MeshDistance(segment).distance({7, 0, 4}), 5.0);
  EXPECT_DOUBLE_EQ(MeshDistance(point).distance({1, 4, 5}), 5.0);
}

TEST(MeshDistance, OfASliverIsNeverTooSmall) {  // a needle, 10 m long and a nanometre wide
  const TriangleMesh needle{{{0, 0, 0}, {10, 0, 0}, {5, 1e-9, 0}}, {{0, 1, 2}}};
  const MeshDistance mesh(needle);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double x = 10.0 * random.uniform(), y = random.normal(), z = random.normal();
    EXPECT_NEAR(mesh.distance({x, y, z}), std::hypot(y, z), 2e-9);
  }
}

TEST(MeshDistances, AreThoseOfTheSinglePointsForAnyNumberOfThreads) {
  const TriangleMesh mesh = randomMesh(6, 500);
  Random random(7);
  std::vector<Vector<3>> points(5000);
  for (Vector<3>& point : points) point = test::randomPoint(random, 8.0);
  const std::vector<double> one = meshDistances(points, mesh, 1);
  ASSERT_EQ(one.size(), points.size());
  for (std::size_t i = 0; i < points.size(); i += 50) EXPECT_NEAR(one[i], test::slowDistance(mesh, points[i]), 1e-11);
  EXPECT_EQ(meshDistances(points, mesh, 2), one);
  EXPECT_EQ(meshDistances(points, MeshDistance(mesh)), one);
  EXPECT_TRUE(meshDistances({}, mesh).empty());
}

TEST(MeshDistances, RefuseWhatHasNone) {
  EXPECT_THROW(MeshDistance(TriangleMesh{}), std::invalid_argument);
  const MeshDistance mesh(oneTriangle());
  EXPECT_THROW(mesh.distance({std::nan(""), 0, 0}), std::invalid_argument);
  try {
    meshDistances({{0, 0, 0}, {0, std::nan(""), 0}}, mesh, 2);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("point 1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gaussmap
