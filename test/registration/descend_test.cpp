// SPDX-License-Identifier: BSD-3-Clause
#include "registration/descend.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gaussmap {
using namespace detail;

namespace {

constexpr DescentLimits kLimits{50, 1e-8, 1e-8};
const HeldDirections kAllFree(1.0);

/// Residual f(x) along x, none along the other axes.
template <typename Residual, typename Slope>
auto along(const Residual& f, const Slope& slope, int* calls = nullptr) {
  return [=](const Pose& pose) {
    if (calls) ++*calls;
    const double x = pose.translation.x();
    NormalEquations equations;
    equations.information = NormalEquations::Matrix6::Identity();
    equations.information(0, 0) = slope(x) * slope(x);
    equations.gradient[0] = slope(x) * f(x);
    equations.cost = f(x) * f(x);
    equations.met = 1;
    return equations;
  };
}

Pose at(double x) {
  return {{x, 0.0, 0.0}, Pose::Rotation::Identity()};
}

TEST(Descend, ShortensStepsThatWouldGoUp) {
  // Newton's step for atan from |x| > 1.39 overshoots to a worse place, each time further.
  const auto arc = along([](double x) { return std::atan(x); }, [](double x) { return 1.0 / (1.0 + x * x); });
  for (const double from : {1.5, 3.0, -10.0}) {
    const DescentResult down = descend(arc, at(from), kLimits, kAllFree);
    EXPECT_TRUE(down.converged) << from;
    EXPECT_NEAR(down.pose.translation.x(), 0.0, 1e-6) << from;
  }
}

TEST(Descend, NeverEndsHigherThanItBegan) {
  const auto waves = along([](double x) { return std::sin(5.0 * x) + 0.3 * x; },
                           [](double x) { return 5.0 * std::cos(5.0 * x) + 0.3; });
  for (int i = -30; i < 30; ++i)
    EXPECT_LE(descend(waves, at(0.1 * i), kLimits, kAllFree).equations.cost, waves(at(0.1 * i)).cost) << i;
}

TEST(Descend, EndsInOneStepWhereTheResidualIsStraight) {
  int calls = 0;
  const auto line = along([](double x) { return 2.0 * (x - 7.0); }, [](double) { return 2.0; }, &calls);
  const DescentResult down = descend(line, at(0.0), DescentLimits{50, 1e-3, 1e-3}, kAllFree);
  EXPECT_NEAR(down.pose.translation.x(), 7.0, 1e-4);
  EXPECT_EQ(down.iterations, 2);  // the second one finds that nothing is left to do
  EXPECT_EQ(calls, 3);
  EXPECT_TRUE(down.converged);
}

TEST(Descend, StopsWhereEveryStepGoesUp) {
  // A slope of the wrong sign: no step is ever taken.
  const auto wrong = along([](double x) { return x; }, [](double) { return -1.0; });
  const DescentResult down = descend(wrong, at(2.0), kLimits, kAllFree);
  EXPECT_EQ(down.pose.translation.x(), 2.0);
  EXPECT_TRUE(down.converged);
  EXPECT_LT(down.iterations, 50);
}

TEST(Descend, DoesNothingWhereNothingIsMet) {
  const DescentResult down = descend([](const Pose&) { return NormalEquations(); }, at(2.0), kLimits, kAllFree);
  EXPECT_EQ(down.iterations, 0);
  EXPECT_FALSE(down.converged);
  EXPECT_EQ(down.pose.translation.x(), 2.0);
}

TEST(Descend, SaysWhenIterationsRunOut) {
  const auto arc = along([](double x) { return std::atan(x); }, [](double x) { return 1.0 / (1.0 + x * x); });
  const DescentResult down = descend(arc, at(3.0), DescentLimits{2, 1e-8, 1e-8}, kAllFree);
  EXPECT_EQ(down.iterations, 2);
  EXPECT_FALSE(down.converged);
}

}  // namespace
}  // namespace gaussmap
