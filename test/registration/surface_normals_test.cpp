// SPDX-License-Identifier: BSD-3-Clause
#include "registration/surface_normals.h"

#include <gtest/gtest.h>

#include <vector>

#include "gaussmap/mapping/build.h"
#include "registration/scan_gaussians.h"

namespace gaussmap {
using namespace detail;

namespace {

/// A floor at z = 0.1, 4 m x 4 m, with a point every `step` metres.
std::vector<Vector<3>> floorPoints(double step, double noise) {
  Random random(1);
  std::vector<Vector<3>> points;
  for (double x = 0.0; x < 4.0; x += step)
    for (double y = 0.0; y < 4.0; y += step) points.emplace_back(x, y, 0.1 + noise * random.normal());
  return points;
}

NormalEquations::Matrix6 sumOn(const GaussianMapOctree& map, const std::vector<Gaussian<3>>& scan, bool lines = false) {
  std::vector<MapNeighbours> scales;
  scales.reserve(std::size_t(map.scales()));
  std::vector<MapNeighbours*> pointers;
  for (int scale = 0; scale < map.scales(); ++scale) {
    scales.emplace_back(map, scale, Vector<3>::Zero());
    scales.back().setBlur(0.1 * map.grid().side(scale));
    pointers.push_back(&scales.back());
  }
  return sumOfNormals(scan, pointers, {}, 3.0, lines);
}

TEST(SumOfNormals, OfOneGaussianOnAFloorIsItsHeightRollAndPitch) {
  const GaussianMapOctree map = build<3>(floorPoints(0.01, 0.0), {0.5, 4, 2, 0.0});
  const Gaussian<3> gaussian{{2.3, 1.3, 0.1}, 1e-4 * Matrix<3>::Identity(), 1.0};
  const NormalEquations::Matrix6 sum = sumOn(map, {gaussian});
  // n = z and the arm a = (2.3, 1.3, 0.1): the row is (n, a x n) = (0, 0, 1, 1.3, -2.3, 0).
  NormalEquations::Vector6 row;
  row << 0.0, 0.0, 1.0, 1.3, -2.3, 0.0;
  EXPECT_GT(sum(2, 2), 0.95);  // the weight
  EXPECT_LE(sum(2, 2), 1.0);
  EXPECT_LT((sum / sum(2, 2) - row * row.transpose()).cwiseAbs().maxCoeff(), 0.01);
}

TEST(SumOfNormals, LeavesOutTheErrorsOfNormals) {
  const GaussianMapOctree map = build<3>(floorPoints(0.08, 0.02), {0.25, 4, 2, 0.0});  // about ten points per cell
  const NormalEquations::Matrix6 sum = sumOn(map, gaussiansOf(map, 0.25, 1000));
  EXPECT_GT(sum(2, 2), 100.0);
  for (const int axis : {0, 1}) EXPECT_LT(sum(axis, axis), 0.003 * sum(2, 2));
}

TEST(SumOfNormals, TakesAWiderCellWhereAFineOneHasOnlyALine) {
  // Lines along x on a floor, 0.3 m apart: a fine cell has one of them, a wide cell several.
  std::vector<Vector<3>> points;
  Random random(2);
  for (double x = 0.0; x < 4.0; x += 0.01)
    for (double y = 0.1; y < 4.0; y += 0.3)
      points.emplace_back(x, y + 0.005 * random.normal(), 0.1 + 0.005 * random.normal());
  const GaussianMapOctree map = build<3>(points, {0.25, 8, 2, 0.0});
  const NormalEquations::Matrix6 sum = sumOn(map, gaussiansOf(map, 0.25, 1000));
  EXPECT_GT(sum(2, 2), 50.0);
  EXPECT_LT(sum(1, 1), 0.02 * sum(2, 2));  // across the lines
  EXPECT_LT(sum(0, 0), 0.02 * sum(2, 2));
  const NormalEquations::Matrix6 with_lines = sumOn(map, gaussiansOf(map, 0.25, 1000), true);
  EXPECT_GT(with_lines(1, 1), 0.1 * with_lines(2, 2));  // of a planar laser, they would be walls
}

TEST(SumOfNormals, IsZeroWhereNothingIsMetOrNothingIsFlat) {
  const Gaussian<3> gaussian{{1.0, 1.0, 1.0}, 1e-4 * Matrix<3>::Identity(), 1.0};
  EXPECT_TRUE(sumOn(build<3>({{100.0, 0.0, 0.0}}, {0.5, 4, 2, 0.0}), {gaussian}).isZero());
  EXPECT_TRUE(sumOn(build<3>({{1.0, 1.0, 1.0}}, {0.5, 4, 2, 0.0}), {gaussian}).isZero(1e-9));
}

TEST(IsOfPlanarLaser, IsTrueOnlyForLinesInOnePlane) {
  std::vector<Vector<3>> room, floor = floorPoints(0.05, 0.0), rings;
  for (double s = 0.0; s < 4.0; s += 0.01) {
    room.emplace_back(s, 0.0, 0.0);
    room.emplace_back(0.0, s, 0.0);
    rings.emplace_back(s, 0.0, 0.0);
    rings.emplace_back(0.0, s, 1.0);
    rings.emplace_back(s, 3.0, 2.0);
  }
  const auto isPlanar = [](const std::vector<Vector<3>>& points) {
    return isOfPlanarLaser(gaussiansOf(build<3>(points, {0.5, 4, 2, 0.0}), 0.5, 1000));
  };
  EXPECT_TRUE(isPlanar(room));
  EXPECT_FALSE(isPlanar(floor));  // a plane, but not of lines
  EXPECT_FALSE(isPlanar(rings));  // lines, but not in a plane
  EXPECT_FALSE(isPlanar({{1.0, 1.0, 1.0}}));
}

}  // namespace
}  // namespace gaussmap
