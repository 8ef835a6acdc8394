// SPDX-License-Identifier: BSD-3-Clause
// What must hold for every Gaussian and every cell: over a million of each, drawn at random.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>

#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/editing/simplify.h"
#include "gaussmap/editing/transform_map.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/gmap/quantise.h"
#include "map/random_clouds.h"
#include "sanitized.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr int kMany = test::kSanitized ? 50000 : 1000000;
__extension__ using Wide = __int128;

template <int D>
bool isPositiveDefinite(const Matrix<D>& cov) {
  return cov.allFinite() && cov == cov.transpose() && Eigen::LLT<Matrix<D>>(cov).info() == Eigen::Success;
}

double logUniform(Random& random, double low, double high) {
  return low * std::exp(random.uniform() * std::log(high / low));
}

Pose::Rotation randomQuaternion(Random& random) {
  return Pose::Rotation(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

template <int D>
Matrix<D> randomRotation(Random& random) {
  if constexpr (D == 2)
    return Eigen::Rotation2Dd(6.283 * random.uniform()).toRotationMatrix();
  else
    return randomQuaternion(random).toRotationMatrix();
}

/// Returns an exactly symmetric covariance, like those of the library.
template <int D>
Matrix<D> turned(const Matrix<D>& rotation, const Matrix<D>& cov) {
  const Matrix<D> result = rotation * cov * rotation.transpose();
  return 0.5 * (result + Matrix<D>(result.transpose()));
}

/// Standard deviations from half a centimetre to 100 m, needles and discs too; 1 to 1e9 points.
template <int D>
Gaussian<D> randomGaussian(Random& random) {
  Gaussian<D> gaussian;
  Matrix<D> variances = Matrix<D>::Zero();
  for (int axis = 0; axis < D; ++axis) {
    variances(axis, axis) = std::pow(logUniform(random, 5e-3, 1e2), 2.0);
    gaussian.mean(axis) = random.normal() * logUniform(random, 1e-3, 1e2);
  }
  gaussian.cov = turned<D>(randomRotation<D>(random), variances);
  gaussian.weight = std::ceil(logUniform(random, 1e-3, 1e9));
  return gaussian;
}

/// KL(p || q) in more digits than the library has.
template <int D>
double exactDivergence(const Gaussian<D>& p, const Gaussian<D>& q) {
  using Long = Eigen::Matrix<long double, D, D, Eigen::DontAlign>;
  const auto factorOf = [](const Gaussian<D>& g) {
    return Long(Long(g.cov.template cast<long double>()).llt().matrixL());
  };
  const Long p_factor = factorOf(p), q_factor = factorOf(q);
  const Long turned = q_factor.template triangularView<Eigen::Lower>().solve(p_factor);
  const Eigen::Matrix<long double, D, 1, Eigen::DontAlign> apart = (q.mean - p.mean).template cast<long double>(),
                                                           off = q_factor.template triangularView<Eigen::Lower>().solve(
                                                               apart);
  long double twice = turned.squaredNorm() + off.squaredNorm() - D;
  for (int i = 0; i < D; ++i) twice -= 2 * std::log(turned(i, i));
  return static_cast<double>(twice / 2);
}

template <int D>
void expectGaussiansKeepTheirProperties() {
  Random random(D);
  Gaussian<D> before = randomGaussian<D>(random);
  std::int64_t indefinite = 0, negative = 0, mass_lost = 0, coarse = 0, moved = 0, wrong = 0, not_zero = 0;
  for (int i = 0; i < kMany; ++i) {
    const Gaussian<D> gaussian = randomGaussian<D>(random);
    indefinite += !isPositiveDefinite<D>(gaussian.cov);
    const Gaussian<D> merged = merge<D>({before, gaussian});
    indefinite += !isPositiveDefinite<D>(merged.cov);
    mass_lost += merged.weight != before.weight + gaussian.weight;
    // The mean lies between the two; no direction has less variance than the parts have on average.
    const Vector<D> step = gaussian.mean - before.mean;
    const double share = gaussian.weight / merged.weight, other = before.weight / merged.weight;
    const double size = before.mean.norm() + gaussian.mean.norm();
    moved += !((merged.mean - before.mean - share * step).norm() <= 1e-14 * size);
    const Matrix<D> spread = other * before.cov + share * gaussian.cov + share * other * step * step.transpose();
    moved += !((merged.cov - spread).norm() <= 1e-13 * (spread.norm() + size * size * 1e-2));
    for (const auto& [p, q] : {std::pair(before, gaussian), std::pair(gaussian, merged), std::pair(merged, before)}) {
      const double divergence = klDivergence<D>(p, q);
      negative += !(divergence >= 0.0);
      if (i % 8 > 0) continue;
      const double exact = exactDivergence<D>(p, q);
      wrong += !(std::abs(divergence - exact) <= 1e-5 * (1.0 + exact));  // variances differ by up to 4e8
    }
    not_zero += !(klDivergence<D>(gaussian, gaussian) <= 1e-9);
    // A finished map's numbers.
    const Gaussian<D> kept =
        dequantise<D>(quantise<D>(gaussian, 0.005), 0.005, std::numeric_limits<double>::infinity());
    indefinite += !isPositiveDefinite<D>(kept.cov);
    const Vector<D> direction = Vector<D>::Unit(static_cast<int>(random.below(D)));
    const double ratio = std::sqrt(direction.dot(kept.cov * direction) / direction.dot(gaussian.cov * direction));
    coarse += !(ratio > 0.95 && ratio < 1.05 && std::abs(kept.weight / gaussian.weight - 1.0) <= 0x1.0p-5);
    before = i % 3 == 0 ? merged : gaussian;  // unions of unions of unions, too
    before.weight = std::min(before.weight, 1e12);
  }
  EXPECT_EQ(indefinite, 0);
  EXPECT_EQ(mass_lost, 0);
  EXPECT_EQ(moved, 0);
  EXPECT_EQ(negative, 0);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(not_zero, 0);
  EXPECT_EQ(coarse, 0);
}

TEST(NumericalProperties, HoldForAMillionGaussiansInSpace) {
  expectGaussiansKeepTheirProperties<3>();
}

TEST(NumericalProperties, HoldForAMillionGaussiansInThePlane) {
  expectGaussiansKeepTheirProperties<2>();
}

/// Points of a cell: a cloud, a line, a plane, one place, or corners of the cell.
std::array<std::int32_t, 3> randomOffset(Random& random, std::uint64_t kind, const std::array<std::int32_t, 3>& base) {
  const auto any = [&] { return static_cast<std::int32_t>(random.below(65536)) - 32768; };
  switch (kind) {
    case 0:
      return {any(), any(), any()};
    case 1: {
      const std::int32_t along = any();
      return {along, along, base[2]};
    }
    case 2:
      return {any(), any(), base[2]};
    case 3:
      return base;
    default:
      return {any() < 0 ? -32768 : 32767, any() < 0 ? -32768 : 32767, any() < 0 ? -32768 : 32767};
  }
}

TEST(NumericalProperties, HoldForAMillionCells) {
  constexpr double kSide = 0.1, kNoise = kSide / 1000, kStep = kSide / kStepsPerCell;
  Random random(4);
  CellMoments<3> before;
  before.add({1, 2, 3});
  std::int64_t indefinite = 0, inexact = 0, off = 0, unmatched = 0;
  for (int i = 0; i < kMany; ++i) {
    CellMoments<3> cell;
    const std::uint64_t kind = random.below(5), points = 1 + random.below(12);
    const std::array<std::int32_t, 3> base = randomOffset(random, 0, {});
    for (std::uint64_t n = 0; n < points; ++n) cell.add(randomOffset(random, kind, base));
    const std::int64_t times = std::int64_t{1} << random.below(29);  // the same points again: up to 2^32 of them
    CellMoments<3> many = cell;
    for (std::int64_t n = 1; n < times; n *= 2) many += CellMoments<3>(many);
    // Doubles beside whole numbers: the variance of a dimension is (n xx - x x) / n^2 exactly.
    const Gaussian<3> gaussian = many.gaussian(kSide, kNoise);
    indefinite += !isPositiveDefinite<3>(gaussian.cov);
    int slot = 0;
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = row; column < 3; ++column, ++slot) {
        const auto at = static_cast<std::size_t>(slot);
        inexact += many.product[at] != cell.product[at] * times;
        const Wide numerator = Wide{many.count} * many.product[at] - Wide{many.sum[row]} * many.sum[column];
        const double n = static_cast<double>(many.count);
        double expected = static_cast<double>(numerator) / n / n * kStep * kStep;
        if (row == column) expected += kNoise * kNoise;
        off += !(std::abs(gaussian.cov(static_cast<int>(row), static_cast<int>(column)) - expected) <=
                 0x1.0p-50 * kSide * kSide);
      }
    // Moment matching of two cells' Gaussians is the Gaussian of all their points.
    CellMoments<3> both = before;
    both += cell;
    const Gaussian<3> matched = merge<3>({before.gaussian(kSide, kNoise), cell.gaussian(kSide, kNoise)});
    const Gaussian<3> direct = both.gaussian(kSide, kNoise);
    indefinite += !isPositiveDefinite<3>(matched.cov);
    unmatched += !(matched.weight == direct.weight && (matched.mean - direct.mean).norm() <= 1e-15 * kSide * 4 &&
                   (matched.cov - direct.cov).norm() <= 0x1.0p-48 * kSide * kSide);
    both -= cell;
    inexact += both != before;
    before = cell;
  }
  EXPECT_EQ(indefinite, 0);
  EXPECT_EQ(inexact, 0);
  EXPECT_EQ(off, 0);
  EXPECT_EQ(unmatched, 0);
}

TEST(NumericalProperties, HoldForMapsThatAreRefinedMovedAndThinned) {
  const std::size_t points = test::kSanitized ? 5000 : 50000;
  Random random(5);
  GaussianMapOctree map = refine<3>(build<3>(test::randomCloud<3>(points, 6), {0.05, 5, 3, 1e-4})).map;
  for (int round = 0; round < 4; ++round) {
    Pose motion;
    motion.rotation = randomQuaternion(random);
    motion.translation = {100.0 * random.normal(), 1e4 * random.normal(), 1e6 * random.normal()};
    TransformOptions options;
    if (round % 2 == 1) options.covariance = 1e-6 * PoseCovariance::Identity();
    map = transformMap<3>(map, motion, options);
    if (round == 2) map = simplify<3>(map, PerCell{2.0}).map;
    for (int s = 0; s < map.scales(); ++s) {
      std::int64_t indefinite = 0;
      for (std::size_t i = 0; i < map.gaussianCount(s); ++i)
        indefinite += !isPositiveDefinite<3>(map.localGaussian(i, s).cov);
      EXPECT_EQ(indefinite, 0) << s;
      EXPECT_NEAR(map.weight(s), static_cast<double>(points), 1e-9 * static_cast<double>(points)) << s;
    }
  }
}

}  // namespace
}  // namespace gaussmap
