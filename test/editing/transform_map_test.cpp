// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/transform_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

#include "editing/thinned_map.h"
#include "io/gmap/map_equality.h"
#include "map/inherit_occupancy.h"
#include "mapping/map_checks.h"

namespace gaussmap::test {
using namespace detail;

namespace {

Pose motion3(const Vector<3>& translation = {12.34, -5.6, 0.78}) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  return {translation, Pose::Rotation(Eigen::AngleAxisd(0.7, axis))};
}
Pose motion2(double angle = 0.7, const Vector<2>& translation = {12.34, -5.6}) {
  return {{translation.x(), translation.y(), 0.0}, Pose::Rotation(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()))};
}
template <int D>
Pose someMotion() {
  if constexpr (D == 2) return motion2();
  if constexpr (D == 3) return motion3();
}

/// All Gaussians of a scale in the map frame, in an order of their own.
template <int D>
std::vector<Gaussian<D>> sortedGaussians(const GaussianMap<D>& map, int s) {
  std::vector<Gaussian<D>> all;
  for (std::size_t i = 0; i < map.gaussianCount(s); ++i) all.push_back(map.gaussian(i, s));
  // By the mean, in steps that are wide beside rounding: the test data have no two means so near on all axes.
  const auto steps = [](const Gaussian<D>& g) {
    std::vector<double> numbers;
    for (int axis = 0; axis < D; ++axis) numbers.push_back(std::floor(g.mean(axis) * 1e5 + 0.123));
    return numbers;
  };
  std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return steps(a) < steps(b); });
  return all;
}

template <int D>
void expectSameGaussians(const GaussianMap<D>& a, const GaussianMap<D>& b, int s, double cells) {
  const std::vector<Gaussian<D>> p = sortedGaussians(a, s), q = sortedGaussians(b, s);
  ASSERT_EQ(p.size(), q.size()) << "scale " << s;
  const double tolerance = cells * a.grid().side(0);
  for (std::size_t i = 0; i < p.size(); ++i) {
    ASSERT_LT((p[i].mean - q[i].mean).norm(), tolerance) << "scale " << s;
    ASSERT_NEAR(p[i].weight, q[i].weight, 1e-9 * p[i].weight);
    ASSERT_LT((p[i].cov - q[i].cov).norm(), 1e-6 * a.grid().side(0) * a.grid().side(0));
  }
}

template <int D>
void expectThereAndBack() {
  const GaussianMap<D> map = build<D>(randomCloud<D>(8000, 1), smallGrid<D>());
  const Pose motion = someMotion<D>();
  const GaussianMap<D> there = transformMap<D>(map, motion), back = transformMap<D>(there, motion.inverse());
  for (int s = 0; s < 3; ++s) expectSameGaussians<D>(map, back, s, 1e-5);
  // At the finest scale for a refined map too.
  const GaussianMap<D> refined = refinedMap<D>(randomCloud<D>(8000, 2), smallGrid<D>());
  expectSameGaussians<D>(refined, transformMap<D>(transformMap<D>(refined, motion), motion.inverse()), 0, 1e-5);
}

TEST(TransformMap, ThereAndBackGivesEveryMeanAndWeight) {
  expectThereAndBack<2>();
  expectThereAndBack<3>();
}

TEST(TransformMap, ThereAndBackHoldsFarFromTheOrigin) {
  const GaussianMap<3> map = build<3>(shifted<3>(randomCloud<3>(2000, 1), {4e6, -3e6, 5e6}), smallGrid<3>());
  const Pose motion = motion3({-4e6, 3e6, 1e6});
  expectSameGaussians<3>(map, transformMap<3>(transformMap<3>(map, motion), motion.inverse()), 0, 1e-5);
}

TEST(TransformMap, MovesTheMatchOfEveryScaleAndKeepsItsWeight) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(8000, 3), smallGrid<3>());
  const Pose motion = motion3();
  const GaussianMap<3> moved = transformMap<3>(map, motion);
  for (int s = 0; s < 3; ++s) {
    Gaussian<3> expected = matchOfScale<3>(map, s);
    const Eigen::Matrix3d rotation = motion.rotation.toRotationMatrix();
    expected.mean = motion * expected.mean;
    expected.cov = rotation * expected.cov * rotation.transpose();
    expectSameMatch<3>(matchOfScale<3>(moved, s), expected);
    EXPECT_EQ(moved.gaussianCount(s), std::max(map.gaussianCount(s), moved.cellCount(s)));
  }
  EXPECT_EQ(moved.gaussianCount(0), map.gaussianCount(0));
  EXPECT_FALSE(moved.acceptsScans());
  expectMomentMatches<3>(moved);
}

TEST(TransformMap, LeavesOneGaussianACellWhereThereWasOne) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(8000, 3), smallGrid<3>());
  const GaussianMap<3> moved = transformMap<3>(map, motion3());
  for (int s = 1; s < 3; ++s) EXPECT_EQ(moved.gaussianCount(s), moved.cellCount(s));
}

TEST(TransformMap, TurnsAGaussianAsOnPaper) {
  // Two points (1.02, 0.05), (1.08, 0.05): mean (1.05, 0.05), variance 9e-4 along x; turned by 90 degrees: along y.
  MapOptions grid = smallGrid<2>();
  grid.noise = 0.01;
  const GaussianMap<2> map = build<2>({{1.02, 0.05}, {1.08, 0.05}}, grid);
  const GaussianMap<2> moved = transformMap<2>(map, motion2(std::acos(-1.0) / 2.0, {0.5, -0.25}));
  ASSERT_EQ(moved.gaussianCount(0), 1u);
  const Gaussian<2> one = moved.gaussian(0, 0);
  EXPECT_NEAR(one.mean.x(), 0.45, 2e-6);
  EXPECT_NEAR(one.mean.y(), 0.80, 2e-6);
  EXPECT_NEAR(one.cov(0, 0), 1e-4, 1e-9);
  EXPECT_NEAR(one.cov(1, 1), 1e-3, 2e-7);
  EXPECT_NEAR(one.cov(0, 1), 0.0, 1e-9);
}

TEST(TransformMap, GivesTheSameMapForTheIdentity) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(3000, 3), smallGrid<3>());
  expectSameMap<3>(transformMap<3>(map, {}), map);
  TransformOptions options;
  options.grid = map.options();
  expectSameMap<3>(transformMap<3>(map, {}, options), map);
  EXPECT_TRUE(transformMap<3>(GaussianMap<3>(smallGrid<3>()), motion3()).empty());
}

TEST(TransformMap, WidensCovariancesAsThePoseIsUncertain) {
  // At 10 m from the origin 0.01 rad are 0.1 m across; the translation is known to 0.02 m along x.
  const GaussianMap<2> map = build<2>({{10.05, 0.05}}, smallGrid<2>());
  TransformOptions options;
  options.covariance = PoseCovariance::Zero();
  (*options.covariance)(0, 0) = 4e-4;
  (*options.covariance)(5, 5) = 1e-4;
  options.covariance->diagonal().segment<3>(2).setConstant(0.01);  // z and rotations about x and y: not in the plane
  const Matrix<2> before = map.gaussian(0, 0).cov, after = transformMap<2>(map, {}, options).gaussian(0, 0).cov;
  EXPECT_NEAR(after(0, 0) - before(0, 0), 4e-4 + 1e-4 * 0.05 * 0.05, 1e-9);
  EXPECT_NEAR(after(1, 1) - before(1, 1), 1e-4 * 10.05 * 10.05, 1e-7);
  EXPECT_NEAR(after(0, 1) - before(0, 1), -1e-4 * 10.05 * 0.05, 1e-8);
}

/// What errors of R and t, drawn at random, do to a point.
TEST(TransformMap, WidensCovariancesAsDrawnErrorsDo) {
  const GaussianMap<3> map = build<3>({{7.05, -3.05, 2.05}}, smallGrid<3>());
  const Pose motion = motion3();
  Random random(5);
  Eigen::Matrix<double, 6, 6> factor;
  for (Eigen::Index i = 0; i < 36; ++i) factor(i / 6, i % 6) = 0.002 * random.normal();
  const PoseCovariance covariance = factor * factor.transpose();
  const Vector<3> point = map.gaussian(0, 0).mean, mean = motion * point;
  Matrix<3> drawn = Matrix<3>::Zero(), drawn_back = drawn;
  constexpr int kDraws = 40000;
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::Matrix<double, 6, 1> z;
    for (Eigen::Index i = 0; i < 6; ++i) z(i) = random.normal();
    const Eigen::Matrix<double, 6, 1> error = factor * z;
    const Eigen::Vector3d turn = error.tail<3>();
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * motion.rotation.toRotationMatrix();
    const Eigen::Vector3d translation = motion.translation + error.head<3>();
    const Vector<3> off = rotation * point + translation - mean;
    drawn += off * off.transpose() / kDraws;
    const Vector<3> off_back = rotation.transpose() * (mean - translation) - point;
    drawn_back += off_back * off_back.transpose() / kDraws;
  }
  const auto widening = [](const GaussianMap<3>& from, const Pose& by, const PoseCovariance& known) {
    TransformOptions options;
    options.covariance = known;
    return Matrix<3>(transformMap<3>(from, by, options).gaussian(0, 0).cov -
                     transformMap<3>(from, by).gaussian(0, 0).cov);
  };
  EXPECT_LT((widening(map, motion, covariance) - drawn).norm(), 0.03 * drawn.norm());
  const PoseCovariance back = covarianceOfInverse(motion, covariance);
  EXPECT_LT((widening(transformMap<3>(map, motion), motion.inverse(), back) - drawn_back).norm(),
            0.03 * drawn_back.norm());
}

TEST(TransformMap, TakesTheCovarianceOfAnInverseBackToItself) {
  Random random(6);
  Eigen::Matrix<double, 6, 6> factor;
  for (Eigen::Index i = 0; i < 36; ++i) factor(i / 6, i % 6) = random.normal();
  const PoseCovariance covariance = factor * factor.transpose();
  const Pose motion = motion3();
  const PoseCovariance again = covarianceOfInverse(motion.inverse(), covarianceOfInverse(motion, covariance));
  EXPECT_LT((again - covariance).norm(), 1e-10 * covariance.norm());
}

TEST(TransformMap, CarriesTheOccupancyOfEveryGaussian) {
  const GaussianMap<3> map = build<3>({{0.05, 0.05, 0.05}, {1.05, 0.05, 0.05}}, smallGrid<3>());
  Pose motion;
  motion.translation = {-3.0, 0.0, 0.0};
  const GaussianMap<3> moved = transformMap<3>(withOccupancy<3>(map, {-1.0f, 2.0f}), motion);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(moved.logOdds(i, 0), moved.gaussian(i, 0).mean.x() < -2.5 ? -1.0f : 2.0f);
  EXPECT_FALSE(transformMap<3>(map, motion).hasOccupancy());
}

TEST(TransformMap, KeepsTheMomentsInCellsOfAnotherSize) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(8000, 4), smallGrid<3>());
  for (const double resolution : {0.03, 0.05, 0.2, 0.37}) {
    TransformOptions options;
    options.grid = MapOptions{resolution, 3, 4, 0.005};
    const GaussianMap<3> sorted = transformMap<3>(map, motion3(), options);
    EXPECT_EQ(sorted.options(), *options.grid);
    EXPECT_EQ(sorted.gaussianCount(0), sorted.cellCount(0));
    expectMomentMatches<3>(sorted);
    const Gaussian<3> whole = matchOfScale<3>(transformMap<3>(map, motion3()), 0);
    for (int s = 0; s < 4; ++s) expectSameMatch<3>(matchOfScale<3>(sorted, s), whole);
    EXPECT_EQ(sorted.cellCount(0) > map.cellCount(0), resolution < 0.1);
  }
}

TEST(TransformMap, SpreadsAPlaneOverSmallerCells) {
  // A full square of 0.4 m in one cell: each of the 4 x 4 smaller cells under it gets its part of the weight.
  std::vector<Vector<2>> points;
  for (int x = 0; x < 80; ++x)
    for (int y = 0; y < 80; ++y) points.emplace_back(0.0025 + 0.005 * x, 0.0025 + 0.005 * y);
  MapOptions grid{0.4, 2, 1, 1e-4};
  TransformOptions options;
  options.grid = MapOptions{0.1, 2, 1, 1e-4};
  const GaussianMap<2> fine = transformMap<2>(build<2>(points, grid), {}, options);
  ASSERT_EQ(fine.cellCount(0), 16u);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(fine.gaussian(i, 0).weight, 400.0);
    EXPECT_NEAR(fine.gaussian(i, 0).cov(0, 0), 0.01 / 12.0, 1e-5);
  }
}

TEST(TransformMap, SortsIntoAnotherRatioWithoutTouchingTheFinestScale) {
  const GaussianMap<3> map = transformMap<3>(refinedMap<3>(randomCloud<3>(5000, 4), smallGrid<3>()), motion3());
  TransformOptions options;
  options.grid = map.options();
  options.grid->ratio = 5;
  const GaussianMap<3> sorted = transformMap<3>(map, {}, options);
  EXPECT_EQ(sorted.options().ratio, 5);
  expectSameGaussians<3>(map, sorted, 0, 1e-9);
  expectMomentMatches<3>(sorted);
}

TEST(TransformMap, IsTheSameForAnyNumberOfThreads) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(5000, 4), smallGrid<3>());
  TransformOptions one, two;
  one.threads = 1;
  two.threads = 2;
  expectSameMap<3>(transformMap<3>(map, motion3(), one), transformMap<3>(map, motion3(), two));
}

template <int D>
void expectRefusal(const GaussianMap<D>& map, const Pose& motion, const std::string& word,
                   const std::optional<PoseCovariance>& covariance = {}) {
  TransformOptions options;
  options.covariance = covariance;
  try {
    transformMap<D>(map, motion, options);
    ADD_FAILURE() << "not refused: " << word;
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(TransformMap, RefusesPosesWithAFault) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(500, 4), smallGrid<3>());
  Pose motion = motion3();
  motion.rotation.coeffs() *= 1.01;
  expectRefusal<3>(map, motion, "has norm 1.01");
  motion.rotation.coeffs().setZero();
  expectRefusal<3>(map, motion, "the quaternion is zero");
  expectRefusal<3>(map, motion3({std::numeric_limits<double>::quiet_NaN(), 0, 0}), "not finite");
  expectRefusal<3>(map, motion3({1e12, 0, 0}), "does not fit 32-bit cell indices");
  expectRefusal<3>(thinned<3>(map), motion3(), "compressed");
}

TEST(TransformMap, NormalisesTheQuaternion) {
  const GaussianMap<3> map = build<3>({{1.05, 0.05, 0.05}}, smallGrid<3>());
  Pose motion = motion3();
  motion.rotation.coeffs() *= 1.0005;
  EXPECT_LT((transformMap<3>(map, motion).gaussian(0, 0).mean - motion3() * map.gaussian(0, 0).mean).norm(), 1e-6);
}

TEST(TransformMap, RefusesCovariancesThatAreNotOfAPose) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(500, 4), smallGrid<3>());
  PoseCovariance covariance = PoseCovariance::Identity();
  covariance(0, 1) = 0.5;
  expectRefusal<3>(map, motion3(), "not symmetric", covariance);
  covariance(1, 0) = 0.5;
  covariance(5, 5) = -1.0;
  expectRefusal<3>(map, motion3(), "positive semi-definite", covariance);
  covariance(5, 5) = std::numeric_limits<double>::infinity();
  expectRefusal<3>(map, motion3(), "not finite", covariance);
}

TEST(TransformMap, RefusesMotionsOutOfThePlane) {
  const GaussianMap<2> map = build<2>(randomCloud<2>(500, 4), smallGrid<2>());
  Pose raised = motion2();
  raised.translation.z() = 0.1;
  expectRefusal<2>(map, raised, "not planar");
  Pose tilted = motion2();
  tilted.rotation = motion3().rotation;
  expectRefusal<2>(map, tilted, "not planar");
}

}  // namespace
}  // namespace gaussmap::test
