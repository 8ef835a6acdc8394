// SPDX-License-Identifier: BSD-3-Clause
// The split of a map by kinds of surface, on surfaces whose kinds are known on paper.
#include "benchmark/budget_by_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "mesh/shapes.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

/// A floor of 8 m x 8 m at z = 0.05 m, and a pole of 10 cm radius and 2 m height at (4, 4).
TriangleMesh floorWithPole() {
  TriangleMesh mesh = rectangleMesh({{0, 0, 0.05}, {8, 0, 0}, {0, 8, 0}});
  append(mesh, cylinderMesh({{4, 4, 0.05}, {0, 0, 2}, 0.1}, 24));
  return mesh;
}

GaussianMap<3> mapOf(const TriangleMesh& mesh) {
  return build<3>(sampleSurface(mesh, 400000), {0.1, 10, 3, 0.0});
}

TEST(SurfaceKinds, AreDetailNearEdgesThinObjectsAndCurvedOnes) {
  TriangleMesh mesh = floorWithPole();
  append(mesh, rectangleMesh({{0, 8, 0.05}, {8, 0, 0}, {0, 0, 3}}));  // a wall along y = 8
  const std::vector<Vector<3>> points = {
      {1, 1, 0.06},    {4.1 + 0.49, 4, 0.04}, {4.1 + 0.51, 4, 0.04}, {4.1, 4, 1},    // floor, beside the pole, the pole
      {1, 7.49, 0.05}, {1, 7.51, 0.05},       {1, 8.01, 0.54},       {1, 8, 0.56}};  // both sides of the corner
  using K = SurfaceKind;
  EXPECT_EQ(surfaceKinds(points, mesh), (std::vector<K>{K::Flat, K::Detail, K::Flat, K::Detail,  //
                                                        K::Flat, K::Detail, K::Detail, K::Flat}));
  SurfaceKindOptions narrow;
  narrow.radius = 0.05;
  EXPECT_EQ(surfaceKinds(points, mesh, narrow), (std::vector<K>{K::Flat, K::Flat, K::Flat, K::Detail,  //
                                                                K::Flat, K::Flat, K::Flat, K::Flat}));
}

TEST(SurfaceKinds, StayFlatWithinTheTolerances) {
  TriangleMesh mesh = rectangleMesh({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  append(mesh, rectangleMesh({{4, 0, 0.01}, {4, 0, 0.35}, {0, 4, 0}}));  // a step of 1 cm and a slope of 5 degrees
  EXPECT_EQ(surfaceKinds({{3.8, 2, 0}}, mesh).front(), SurfaceKind::Flat);
  SurfaceKindOptions options;
  options.tolerance = 0.005;
  EXPECT_EQ(surfaceKinds({{3.8, 2, 0}}, mesh, options).front(), SurfaceKind::Detail);
  options = {};
  options.angle_deg = 4.0;
  EXPECT_EQ(surfaceKinds({{3.8, 2, 0}}, mesh, options).front(), SurfaceKind::Detail);
}

TEST(BudgetBySurface, CountsEachGaussianAndEachFinestCellOnce) {
  const TriangleMesh mesh = floorWithPole();
  const GaussianMap<3> map = refine(mapOf(mesh), PerCell{1.5}).map;
  std::size_t detail = 0;  // within 0.5 m of the pole, by geometry
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i)
    if ((map.gaussian(i, 0).mean.head<2>() - Vector<2>(4, 4)).norm() <= 0.6) ++detail;
  for (const int scale : {0, 1, 2}) {
    const BudgetBySurface budget = budgetBySurface(map, scale, mesh);
    EXPECT_EQ(budget.flat.gaussians + budget.detail.gaussians, map.gaussianCount(scale));
    EXPECT_NEAR(budget.detail.area, 0.01 * double(detail), 0.03);  // the facets lie up to 1 mm inside the cylinder
    EXPECT_NEAR(budget.flat.area + budget.detail.area, 0.01 * double(map.cellCount(0)), 1e-9);
  }
  const BudgetBySurface budget = budgetBySurface(map, 1, mesh);
  EXPECT_EQ(budget.flat.cells, 64u);             // the floor
  EXPECT_EQ(budget.detail.cells, 4u + 4u + 4u);  // floor, middle and top of the pole, which is on a corner of cells
  EXPECT_GT(budget.detail.perCell(), 2.0 * budget.flat.perCell());
  EXPECT_GT(budget.detail.perHundredSquareMetres(), 3.0 * budget.flat.perHundredSquareMetres());
  EXPECT_GT(budget.detailShareOfGaussians(), 2.0 * budget.detailShareOfArea());
}

TEST(BudgetBySurface, RefusesWhatItCannotCount) {
  const TriangleMesh mesh = floorWithPole();
  const GaussianMap<3> map = mapOf(mesh);
  EXPECT_THROW(budgetBySurface(map, 3, mesh), std::out_of_range);
  EXPECT_THROW(budgetBySurface(map, -1, mesh), std::out_of_range);
  EXPECT_THROW(budgetBySurface(map, 1, TriangleMesh()), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap::benchmark
