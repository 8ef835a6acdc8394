// SPDX-License-Identifier: BSD-3-Clause
// When a registration ends, and what it says then: beside PCL's own classes, with the same calls.
// PCL's own templates: g++ 12 warns of what it has inlined into them.
#pragma GCC diagnostic ignored "-Warray-bounds"
#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/pcl/registration.h"

namespace gaussmap {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Ours = GaussianMapRegistration<Point, Point>;
using Ndt = pcl::NormalDistributionsTransform<Point, Point>;
using Icp = pcl::IterativeClosestPoint<Point, Point>;

/// The corner of a room: a floor and two walls, 6 m x 6 m, with 1 cm of noise.
Cloud::Ptr corner(std::uint64_t seed) {
  Random random(seed);
  auto cloud = pcl::make_shared<Cloud>();
  for (int i = 0; i < 3000; ++i) {
    const auto a = static_cast<float>(6.0 * random.uniform()), b = static_cast<float>(6.0 * random.uniform()),
               noise = static_cast<float>(0.01 * random.normal());
    cloud->push_back(i % 3 == 0 ? Point(a, b, noise) : i % 3 == 1 ? Point(a, noise, b) : Point(noise, a, b));
  }
  return cloud;
}

/// A floor, 1.5 m below the sensor.
Cloud::Ptr floorOf(float side, int count, std::uint64_t seed) {
  Random random(seed);
  auto cloud = pcl::make_shared<Cloud>();
  for (int i = 0; i < count; ++i)
    cloud->emplace_back(side * static_cast<float>(random.uniform() - 0.5),
                        side * static_cast<float>(random.uniform() - 0.5),
                        static_cast<float>(-1.5 + 0.01 * random.normal()));
  return cloud;
}

Eigen::Matrix4f shifted(float x, float y, float z) {
  Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
  matrix.topRightCorner<3, 1>() << x, y, z;
  return matrix;
}

// A shift of 0.2 m, larger than nearly any step of these registrations, and one of 1 um; a turn of 84 degrees, and a
// cosine that no turn has. PCL's cosines are floats, which are 1 for small turns.
constexpr double kAnyLength = 0.04, kTinyLength = 1e-12, kAnyTurn = 0.1, kNoTurn = 1.5;

/// Aligns the corner with itself from 0.12 m away, with both epsilons.
template <typename Registration>
void alignCorners(Registration& registration, double squared, double cosine) {
  registration.setTransformationEpsilon(squared);
  registration.setTransformationRotationEpsilon(cosine);
  registration.setInputTarget(corner(1));
  registration.setInputSource(corner(2));
  Cloud output;
  registration.align(output, shifted(0.1f, 0.05f, -0.05f));
}

template <typename Registration>
int iterationsWith(double squared, double cosine) {
  Registration registration;
  registration.setMaximumIterations(8);
  alignCorners(registration, squared, cosine);
  return registration.getFinalNumIteration();
}

/// The cases are the same for NDT and for our class.
template <typename Registration>
class EpsilonsOf : public testing::Test {};
using WithEpsilons = testing::Types<Ndt, Ours>;
TYPED_TEST_SUITE(EpsilonsOf, WithEpsilons, );

TYPED_TEST(EpsilonsOf, EndARegistrationOnlyWhenBothAllowIt) {
  const int fewest = iterationsWith<TypeParam>(kAnyLength, kAnyTurn);
  EXPECT_GT(iterationsWith<TypeParam>(kTinyLength, kAnyTurn), fewest);
  EXPECT_GT(iterationsWith<TypeParam>(kAnyLength, kNoTurn), fewest);
}

TYPED_TEST(EpsilonsOf, DoNotCountIfTheyAreZeroOrLess) {
  const int fewest = iterationsWith<TypeParam>(kAnyLength, kAnyTurn);
  for (const double none : {0.0, -1.0}) {
    EXPECT_EQ(iterationsWith<TypeParam>(kAnyLength, none), fewest);
    EXPECT_LE(iterationsWith<TypeParam>(none, kAnyTurn), fewest);
    EXPECT_GT(iterationsWith<TypeParam>(kTinyLength, none), fewest);
    EXPECT_GT(iterationsWith<TypeParam>(none, kNoTurn), fewest);
    EXPECT_GT(iterationsWith<TypeParam>(none, none), fewest);
  }
}

TEST(GaussianMapRegistrationSettings, AreASquaredLengthAndACosine) {
  GaussianMapRegistrationOptions options;
  options.registration.translation = 0.02;
  options.registration.rotation = 0.003;
  Ours by_options(options), by_setters;
  EXPECT_NEAR(by_options.getTransformationEpsilon(), 4e-4, 1e-15);
  EXPECT_NEAR(by_options.getTransformationRotationEpsilon(), std::cos(0.003), 1e-15);
  alignCorners(by_options, by_options.getTransformationEpsilon(), by_options.getTransformationRotationEpsilon());
  alignCorners(by_setters, 0.02 * 0.02, std::cos(0.003));
  EXPECT_EQ(by_setters.getFinalTransformation(), by_options.getFinalTransformation());
  EXPECT_EQ(by_setters.getFinalNumIteration(), by_options.getFinalNumIteration());
  Ours closer;
  alignCorners(closer, 1e-6 * 1e-6, std::cos(1e-7));
  EXPECT_GT(closer.getFinalNumIteration(), by_setters.getFinalNumIteration());
}

TEST(GaussianMapRegistrationSettings, GiveTheNumberOfIterations) {
  Ours ours;
  EXPECT_EQ(ours.getFinalNumIteration(), 0);
  alignCorners(ours, 1e-6, 1.0 - 1e-9);
  EXPECT_EQ(ours.getFinalNumIteration(), ours.result().iterations);
  EXPECT_GE(ours.getFinalNumIteration(), 8);  // four scales, two steps each
  EXPECT_TRUE(ours.hasConverged());
  ours.setMaximumIterations(1);
  Cloud output;
  ours.align(output, shifted(0.3f, 0.2f, -0.1f));
  EXPECT_EQ(ours.getFinalNumIteration(), 8);
  EXPECT_FALSE(ours.hasConverged());
}

/// Registrations whose target says nothing, quietly.
class TargetsThatTellNothing : public testing::Test {
 protected:
  void SetUp() override { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  void TearDown() override { pcl::console::setVerbosityLevel(pcl::console::L_INFO); }

  template <typename Registration>
  bool convergesOn(const Cloud::Ptr& target) {
    Registration registration;
    registration.setInputTarget(target);
    registration.setInputSource(corner(2));
    Cloud output;
    const Eigen::Matrix4f guess = shifted(0.3f, 0.2f, -0.1f);
    registration.align(output, guess);
    if (std::is_same_v<Registration, Ours> && registration.getInputTarget()) {
      EXPECT_EQ(registration.getFinalTransformation(), guess);
      EXPECT_EQ(output.size(), corner(2)->size());
    }
    return registration.hasConverged();
  }
};

TEST_F(TargetsThatTellNothing, NeverConvergeAsWithNdt) {
  for (const std::size_t count : {0u, 1u, 2u}) {
    const auto few = pcl::make_shared<Cloud>();
    for (std::size_t i = 0; i < count; ++i) few->emplace_back(3.0f, 0.1f * static_cast<float>(i), 0.0f);
    EXPECT_FALSE(convergesOn<Ours>(few)) << count;
    EXPECT_FALSE(convergesOn<Ndt>(few)) << count;
  }
}

TEST_F(TargetsThatTellNothing, NeverConvergeWithOnePlaceOfManyPoints) {
  EXPECT_FALSE(convergesOn<Ours>(Cloud(50, 1, Point(3.0f, 0.0f, 0.0f)).makeShared()));
}

TEST_F(TargetsThatTellNothing, NeverConvergeWithASourceOfOneOrTwoPointsAsWithIcp) {
  for (const std::size_t count : {1u, 2u}) {
    const auto few = pcl::make_shared<Cloud>();
    for (std::size_t i = 0; i < count; ++i) few->emplace_back(3.0f, 2.0f * static_cast<float>(i), 0.0f);
    const auto converges = [&](auto&& registration) {
      registration.setInputTarget(corner(1));
      registration.setInputSource(few);
      Cloud output;
      registration.align(output);
      return registration.hasConverged();
    };
    EXPECT_FALSE(converges(Ours())) << count;
    EXPECT_FALSE(converges(Icp())) << count;
  }
}

TEST(GaussianMapRegistrationOnAPlane, KeepsTheGuessInThePlane) {
  for (const double resolution : {0.5, 0.2}) {
    Ours ours;
    ours.setResolution(resolution);
    ours.setInputTarget(floorOf(20.0f, 60000, 1));
    ours.setInputSource(floorOf(8.0f, 20000, 2));
    Cloud output;
    ours.align(output, shifted(0.05f, 0.03f, 0.02f));
    EXPECT_TRUE(ours.hasConverged());
    EXPECT_TRUE(ours.isDegenerate());
    const Eigen::Matrix4f found = ours.getFinalTransformation();
    EXPECT_NEAR(found(0, 3), 0.05f, 0.002f);
    EXPECT_NEAR(found(1, 3), 0.03f, 0.002f);
    EXPECT_NEAR(found(2, 3), 0.0f, 0.005f);
    EXPECT_NEAR(found(1, 0), 0.0f, 0.001f);  // heading
    const Eigen::Matrix<double, 6, 6> covariance = ours.getPoseCovariance();
    EXPECT_GT(covariance(0, 0), 4.0);
    EXPECT_GT(covariance(5, 5), 0.5);
    EXPECT_LT(covariance(2, 2), 0.01);
    EXPECT_GT((Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(covariance).eigenvalues()[0]), 0.0);
  }
}

}  // namespace
}  // namespace gaussmap
