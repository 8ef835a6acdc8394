// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "mesh/mesh_pieces.h"

namespace gaussmap {
namespace {

using test::oneTriangle;

/// Triangles of 6 m^2 and 18 m^2, one without area between them.
TriangleMesh threeTriangles() {
  TriangleMesh mesh = oneTriangle();
  append(mesh, {{{7, 7, 7}}, {{0, 0, 0}}});
  append(mesh, {{{0, 0, 9}, {6, 0, 9}, {0, 6, 9}}, {{0, 1, 2}}});
  return mesh;
}

TEST(TriangleMesh, HasTheAreaOfItsTriangles) {
  EXPECT_DOUBLE_EQ(surfaceArea(oneTriangle()), 6.0);
  EXPECT_DOUBLE_EQ(surfaceArea(threeTriangles()), 24.0);
  EXPECT_EQ(surfaceArea({}), 0.0);
}

TEST(TriangleMesh, AppendsPartsWithTheirOwnVertices) {
  const TriangleMesh mesh = threeTriangles();
  EXPECT_EQ(mesh.vertices.size(), 7u);
  EXPECT_EQ(mesh.triangles[1], (TriangleMesh::Triangle{3, 3, 3}));
  EXPECT_EQ(mesh.triangles[2], (TriangleMesh::Triangle{4, 5, 6}));
  TriangleMesh twice = oneTriangle();
  append(twice, twice);
  EXPECT_EQ(twice.triangles[1], (TriangleMesh::Triangle{3, 4, 5}));
  EXPECT_EQ(twice.vertices[4], oneTriangle().vertices[1]);
}

TEST(TriangleMesh, MovesAsAWhole) {
  const Pose quarter{{1, 2, 3}, Pose::Rotation(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()))};
  const TriangleMesh mesh = transformed(oneTriangle(), quarter);
  EXPECT_LT((mesh.vertices[1] - Eigen::Vector3d(1, 6, 3)).norm(), 1e-12);
  EXPECT_LT((mesh.vertices[2] - Eigen::Vector3d(-2, 2, 3)).norm(), 1e-12);
}

TEST(TriangleMesh, IsRefusedWithAFault) {
  EXPECT_NO_THROW(checkMesh(threeTriangles()));
  TriangleMesh mesh = oneTriangle();
  mesh.triangles[0][1] = 3;
  EXPECT_THROW(checkMesh(mesh), std::invalid_argument);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e71}) {
    mesh = oneTriangle();
    mesh.vertices[2].y() = bad;
    EXPECT_THROW(checkMesh(mesh), std::invalid_argument);
  }
}

TEST(SampleSurface, GivesEachTriangleItsShareOfTheArea) {
  for (const std::size_t count : {1u, 7u, 24u, 100u, 2401u}) {
    const std::vector<Eigen::Vector3d> points = sampleSurface(threeTriangles(), count, 3);
    ASSERT_EQ(points.size(), count);
    double below = 0.0;
    for (const Eigen::Vector3d& point : points) {
      ASSERT_TRUE(point.z() == 0.0 || point.z() == 9.0);
      below += point.z() == 0.0;
    }
    EXPECT_LT(std::abs(below - double(count) / 4.0), 1.0) << count;
  }
}

TEST(SampleSurface, IsEvenWithinATriangle) {  // centre of mass, and the half beyond the middle line has 1/4
  const std::size_t count = 40000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t beyond = 0;
  for (const Eigen::Vector3d& point : sampleSurface(oneTriangle(), count)) {
    ASSERT_TRUE(point.x() >= 0.0 && point.y() >= 0.0 && point.x() / 4 + point.y() / 3 <= 1.0 + 1e-12);
    sum += point;
    beyond += point.x() > 2.0;
  }
  EXPECT_LT((sum / double(count) - Eigen::Vector3d(4.0 / 3, 1, 0)).norm(), 0.02);
  EXPECT_NEAR(double(beyond) / double(count), 0.25, 0.01);
}

TEST(SampleSurface, DependsOnTheSeedAndNothingElse) {
  EXPECT_EQ(sampleSurface(threeTriangles(), 50, 1), sampleSurface(threeTriangles(), 50, 1));
  EXPECT_NE(sampleSurface(threeTriangles(), 50, 1), sampleSurface(threeTriangles(), 50, 2));
}

TEST(SampleSurface, RefusesAMeshWithoutArea) {
  EXPECT_THROW(sampleSurface(TriangleMesh(), 1), std::invalid_argument);
  EXPECT_THROW(sampleSurface({{{1, 1, 1}}, {{0, 0, 0}}}, 1), std::invalid_argument);
  EXPECT_TRUE(sampleSurface(TriangleMesh(), 0).empty());
  EXPECT_THROW(sampleSurface({{}, {{0, 1, 2}}}, 5), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
