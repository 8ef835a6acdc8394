// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "gaussmap/core/gaussian.h"
#include "mesh/mesh_measures.h"
#include "mesh/mesh_tree.h"

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
  for (const Eigen::Vector3d& vertex : cylinderMesh(pipe, 17).vertices)
    EXPECT_NEAR((vertex - pipe.base).cross(pipe.axis.normalized()).norm(), pipe.radius, 1e-12);
  for (const Eigen::Vector3d& vertex : ellipsoidMesh({1, 0, 0}, {1, 2, 3}, 17).vertices)
    EXPECT_NEAR((vertex - Eigen::Vector3d(1, 0, 0)).cwiseQuotient(Eigen::Vector3d(1, 2, 3)).norm(), 1.0, 1e-12);
  const Rectangle door{{2, 0, 0}, {0, 1, 0}, {0, 0, 2}};
  EXPECT_DOUBLE_EQ(surfaceArea(rectangleMesh(door)), 2.0);
  const std::vector<Eigen::Vector3d> corners = {{2, 0, 0}, {2, 1, 0}, {2, 1, 2}, {2, 0, 2}};
  EXPECT_EQ(rectangleMesh(door).vertices, corners);
}

TEST(MeshShapes, RefuseTooFewFacets) {
  EXPECT_THROW(cylinderMesh({{0, 0, 0}, {0, 0, 1}, 1}, 2), std::invalid_argument);
  EXPECT_THROW(ellipsoidMesh({0, 0, 0}, {1, 1, 1}, 2), std::invalid_argument);
  EXPECT_THROW(profileMesh({{0, 0}}, 0, 0, 1), std::invalid_argument);
}

TEST(FacetsWithin, StaysAsNearToTheCircleAsAsked) {
  const double radius = 0.15;
  for (const double deviation : {1e-2, 1e-3, 1e-5}) {
    const TriangleMesh pole = cylinderMesh({{1, 2, 0}, {0, 0, 4}, radius}, facetsWithin(deviation, radius));
    double farthest = 0.0;
    for (const Eigen::Vector3d& point : sampleSurface(pole, 20000))
      farthest = std::max(farthest, radius - (point - Eigen::Vector3d(1, 2, 0)).head<2>().norm());
    EXPECT_LT(farthest, deviation * (1.0 + 1e-9));
    EXPECT_GT(farthest, 0.5 * deviation);  // no more facets than needed
  }
  EXPECT_GE(facetsWithin(10.0, 0.1), 3);
  EXPECT_EQ(facetsWithin(1e-15, 100.0), kMaxFacets);
  EXPECT_THROW(facetsWithin(0.0, 1.0), std::invalid_argument);
}

TEST(CylinderMesh, IsMetByRaysWhereTheCylinderIs) {
  const double radius = 0.5;
  const MeshTree tree(cylinderMesh({{0, 0, -50}, {0, 0, 100}, radius}, facetsWithin(1e-6, radius)));
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d origin(-3.0, 2.0 * random.uniform() - 1.0, random.normal());
    const Eigen::Vector3d direction = Eigen::Vector3d(1.0, 0.0, 0.3 * random.normal()).normalized();
    const std::optional<MeshHit> hit = tree.intersect(origin, direction);
    const double aside = std::abs(origin.y());
    if (std::abs(aside - radius) > 1e-5) {
      ASSERT_EQ(hit.has_value(), aside < radius);
    }
    if (!hit) continue;
    ++hits;
    const double range = (3.0 - std::sqrt(std::max(0.0, radius * radius - aside * aside))) / direction.x();
    ASSERT_NEAR(hit->range, range, 2e-2);  // 1e-6 m across, but more along a ray that grazes the side
    ASSERT_NEAR((origin + hit->range * direction).head<2>().norm(), radius, 2e-6);
  }
  EXPECT_GT(hits, 2000);
}

}  // namespace
}  // namespace gaussmap
