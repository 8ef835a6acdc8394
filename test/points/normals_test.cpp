// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/points/normals.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kDegree = 3.14159265358979323846 / 180.0;

using Points = std::vector<std::array<float, 3>>;

struct Normals {
  std::vector<std::array<float, 4>> records;  // normal, curvature
  std::size_t without = 0;

  Eigen::Vector3d normal(std::size_t i) const {
    return {double(records[i][0]), double(records[i][1]), double(records[i][2])};
  }
};

PointsView viewOf(const Points& points) {
  return {points.empty() ? nullptr : points[0].data(), points.size(), 3};
}

Normals normalsOf(const Points& surface, const Points& queries, const PointNormalOptions& options = {}) {
  Normals normals;
  normals.records.assign(queries.size() + 1, {7, 7, 7, 7});
  normals.without = pointNormals(viewOf(surface), viewOf(queries),
                                 {normals.records[0].data(), normals.records[0].data() + 3, 4}, options);
  EXPECT_EQ(normals.records.back()[0], 7.0f);  // nothing behind the end
  normals.records.pop_back();
  return normals;
}

Points ball(std::size_t count, double radius) {
  Random random(3);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p = radius * Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    points.push_back({float(p.x()), float(p.y()), float(p.z())});
  }
  return points;
}

/// z = 0.5 x + 0.2 y, in heaps of very different density.
Points slope(std::size_t count) {
  Random random(4);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double r = std::pow(10.0, -2.0 + 3.0 * random.uniform()), angle = 6.3 * random.uniform();
    const double x = r * std::cos(angle), y = r * std::sin(angle);
    points.push_back({float(x), float(y), float(0.5 * x + 0.2 * y)});
  }
  return points;
}

TEST(PointNormals, AreThoseOfAPlaneAtAnyDensity) {
  const Points points = slope(5000);
  PointNormalOptions options;
  options.viewpoint = {0, 0, 100};
  const Normals normals = normalsOf(points, points, options);
  EXPECT_EQ(normals.without, 0u);
  const Eigen::Vector3d expected = Eigen::Vector3d(-0.5, -0.2, 1).normalized();
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GT(normals.normal(i).dot(expected), 1.0 - 1e-6);
    EXPECT_NEAR(normals.records[i][3], 0.0f, 1e-6f);
  }
}

TEST(PointNormals, FollowABallAndLookAtTheViewpoint) {
  const Points points = ball(20000, 2.0);
  for (const double z : {0.0, 1e4}) {
    PointNormalOptions options;
    options.viewpoint = {0, 0, z};
    const Normals normals = normalsOf(points, points, options);
    double worst = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p(points[i][0], points[i][1], points[i][2]);
      worst = std::max(worst, std::acos(std::min(1.0, std::abs(normals.normal(i).dot(p.normalized())))));
      EXPECT_GE(normals.normal(i).dot(options.viewpoint - p), 0.0);
      EXPECT_NEAR(normals.normal(i).norm(), 1.0, 1e-6);
      EXPECT_LT(normals.records[i][3], 0.05f);
    }
    EXPECT_LT(worst, 12 * kDegree);
  }
}

/// The documented rule by brute force: blocks around a query from the coarsest on, down as long as the next finer one
/// has 2.5 times as many points as it takes.
void expectFinestBlocks(const Points& points, const Points& queries, std::size_t min_points) {
  PointNormalOptions options;
  options.min_points = int(min_points);
  const Normals normals = normalsOf(points, queries, options);
  // The cube of cells: from the least coordinates, as wide as the widest axis.
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (const Points* of : {&points, &queries})
    for (const auto& p : *of)
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], double(p[std::size_t(axis)]));
        high[axis] = std::max(high[axis], double(p[std::size_t(axis)]));
      }
  const double side = (high - low).maxCoeff();
  const auto cellOf = [&](const std::array<float, 3>& p, int level) {
    Eigen::Vector3i cell;
    for (int axis = 0; axis < 3; ++axis)
      cell[axis] = int((double(p[std::size_t(axis)]) - low[axis]) * (2097151.0 / side)) >> level;
    return cell;
  };
  for (std::size_t q = 0; q < queries.size(); q += 97) {
    std::vector<std::size_t> chosen;
    const auto block = [&](int level, int reach) {
      std::vector<std::size_t> members;
      const Eigen::Vector3i own = cellOf(queries[q], level);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Array3i off = (cellOf(points[i], level) - own).array().abs();
        if (off.maxCoeff() <= reach && (off == 2).count() <= 1) members.push_back(i);
      }
      return members;
    };
    for (int level = 21;; --level) {
      const auto finer = block(level - 1, 1);
      if (double(finer.size()) >= 2.5 * double(min_points)) continue;
      chosen = finer.size() >= min_points ? finer : block(level - 1, 2);
      if (chosen.size() < min_points) chosen = block(level, 1);
      break;
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::size_t i : chosen) mean += Eigen::Vector3d(points[i][0], points[i][1], points[i][2]);
    mean /= double(chosen.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const std::size_t i : chosen) {
      const Eigen::Vector3d d = Eigen::Vector3d(points[i][0], points[i][1], points[i][2]) - mean;
      spread += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    EXPECT_GT(std::abs(solver.eigenvectors().col(0).dot(normals.normal(q))), 1.0 - 1e-5);
    EXPECT_NEAR(solver.eigenvalues()[0] / spread.trace(), double(normals.records[q][3]), 1e-5);
  }
}

TEST(PointNormals, AreOfTheFinestBlockThatHoldsEnoughPoints) {
  const Points points = ball(3000, 1.0);
  for (const std::size_t min_points : {9, 14, 1000}) expectFinestBlocks(points, points, min_points);
}

TEST(PointNormals, BesideTheSurfaceAreOfTheFinestBlockThatHoldsEnoughPoints) {
  for (const std::size_t min_points : {9, 14}) expectFinestBlocks(ball(3000, 1.0), ball(2000, 0.97), min_points);
}

TEST(PointNormals, OfChosenQueriesAreThoseOfAllOfThem) {
  const Points points = slope(3000);
  Points some;
  for (std::size_t i = 5; i < points.size(); i += 7) some.push_back(points[i]);
  const Normals all = normalsOf(points, points), chosen = normalsOf(points, some);
  for (std::size_t j = 0; j < some.size(); ++j) EXPECT_EQ(chosen.records[j], all.records[5 + 7 * j]);
}

TEST(PointNormals, OfPlacesBesideTheSurfaceAreThoseOfTheSurfaceThere) {
  Points points = slope(3000), above;
  for (std::size_t i = 0; i < 50; ++i) above.push_back({0.1f * float(i), 0, 0.05f * float(i) + 0.01f});
  const Normals normals = normalsOf(points, above);
  const Eigen::Vector3d expected = Eigen::Vector3d(-0.5, -0.2, 1).normalized();
  EXPECT_EQ(normals.without, 0u);
  for (std::size_t j = 0; j < above.size(); ++j) EXPECT_GT(std::abs(normals.normal(j).dot(expected)), 1.0 - 1e-6);
}

TEST(PointNormals, DoNotDependOnThreads) {
  const Points points = ball(30000, 3.0);
  PointNormalOptions one, two;
  one.threads = 1;
  two.threads = 2;
  EXPECT_EQ(normalsOf(points, points, one).records, normalsOf(points, points, two).records);
  Points beside = ball(20000, 3.1);
  beside.push_back({1e6f, 0, 0});
  EXPECT_EQ(normalsOf(points, beside, one).records, normalsOf(points, beside, two).records);
}

TEST(PointNormals, LeaveOutPointsThatAreNone) {
  Points points = slope(500);
  const Normals clean = normalsOf(points, points);
  points.push_back({kNan, 0, 0});
  points.push_back({0, std::numeric_limits<float>::infinity(), 0});
  const Normals normals = normalsOf(points, points);
  EXPECT_EQ(normals.without, 2u);
  for (std::size_t i = 0; i < 500; ++i) EXPECT_EQ(normals.records[i], clean.records[i]);
  for (const std::size_t i : {500u, 501u})
    for (const float value : normals.records[i]) EXPECT_TRUE(std::isnan(value));
}

TEST(PointNormals, AreNoneOfTooFewEqualOrAlignedPoints) {
  EXPECT_EQ(normalsOf({}, {}).without, 0u);
  EXPECT_EQ(normalsOf({}, {{0, 0, 0}}).without, 1u);
  EXPECT_EQ(normalsOf({{0, 0, 0}}, {{0, 0, 0}}).without, 1u);
  EXPECT_EQ(normalsOf({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}}).without, 1u);
  const Points equal(100, {1, 2, 3});
  EXPECT_EQ(normalsOf(equal, equal).without, 100u);
  Points line;
  for (int i = 0; i < 1000; ++i) line.push_back({0.1f * float(i), 0.2f * float(i), -0.3f * float(i)});
  EXPECT_EQ(normalsOf(line, line).without, 1000u);
  const Points three = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const Normals normals = normalsOf(three, three);
  EXPECT_EQ(normals.without, 0u);
  EXPECT_NEAR(normals.records[0][2], -1.0f, 1e-6f);  // towards the origin
}

TEST(PointNormals, OfFarCloudsAreThoseOfNearOnes) {
  Points far;
  Random random(9);
  for (int i = 0; i < 2000; ++i)  // whole metres: exact in floats
    far.push_back({1e7f + float(random.below(300)), -1e7f + float(random.below(300)), 1e7f});
  const Normals normals = normalsOf(far, far);
  EXPECT_EQ(normals.without, 0u);
  for (std::size_t i = 0; i < far.size(); ++i) EXPECT_NEAR(std::abs(normals.records[i][2]), 1.0f, 1e-5f);
}

TEST(PointNormals, DoNotSufferFromStrayPoints) {
  const Points points = ball(5000, 1.0);
  Points strayed = points;
  strayed.push_back({1e7f, 1e7f, -1e7f});
  const Normals normals = normalsOf(strayed, strayed);
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p(points[i][0], points[i][1], points[i][2]);
    worst = std::max(worst, std::acos(std::min(1.0, std::abs(normals.normal(i).dot(p)))));
  }
  EXPECT_LT(worst, 20 * kDegree);
  EXPECT_EQ(normals.without, 0u);  // the stray one's is that of all points
}

TEST(PointNormals, NameTheOptionThatIsNone) {
  const Points points = slope(10);
  for (const int min_points : {-1, 2, 1001}) {
    PointNormalOptions options;
    options.min_points = min_points;
    EXPECT_THROW(normalsOf(points, points, options), std::invalid_argument);
  }
  PointNormalOptions options;
  options.viewpoint.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(normalsOf(points, points, options), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
