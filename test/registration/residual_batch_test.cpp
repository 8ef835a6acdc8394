// SPDX-License-Identifier: BSD-3-Clause
#include "registration/residual_batch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

using Meeting = std::pair<Gaussian<3>, MapGaussian>;

Vector<3> direction(Random& random) {
  return Vector<3>(random.normal(), random.normal(), random.normal()).normalized();
}

Matrix<3> anyRotation(Random& random) {
  return Eigen::AngleAxisd(3.0 * random.uniform(), direction(random)).toRotationMatrix();
}

Pose anyPose(Random& random) {
  return {0.1 * direction(random), Pose::Rotation(anyRotation(random))};
}

Meeting anyMeeting(Random& random) {
  const Matrix<3> axes = anyRotation(random);
  const Vector<3> variances = 0.1 * Vector<3>(random.uniform(), random.uniform(), random.uniform());
  return {{direction(random), axes * variances.asDiagonal() * axes.transpose(), 1.0},
          {direction(random),
           anyRotation(random),
           {0.01 + 0.1 * random.uniform(), random.uniform(), random.uniform()},
           {1.0, random.uniform(), 0.0}}};
}

NormalEquations sumOf(const std::vector<Meeting>& meetings, const Pose& pose, double blur_squared, double kernel) {
  ResidualBatch batch;
  for (const auto& [gaussian, target] : meetings) batch.add(gaussian, target);
  return batch.sumUp(pose.rotation.toRotationMatrix(), pose.translation, blur_squared, kernel);
}

/// The same one by one, as it is written on paper.
NormalEquations plainSumOf(const std::vector<Meeting>& meetings, const Pose& pose, double blur_squared, double kernel) {
  NormalEquations sums;
  const Matrix<3> rotation = pose.rotation.toRotationMatrix();
  for (const auto& [gaussian, target] : meetings) {
    const Vector<3> arm = rotation * gaussian.mean, residual = arm + pose.translation - target.mean;
    const Matrix<3> turned = rotation * gaussian.cov * rotation.transpose();
    double squared = 0.0;
    NormalEquations one;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector<3> a = target.directions.col(axis);
      const double information = target.tells[axis] / (target.variances[axis] + blur_squared + a.dot(turned * a));
      NormalEquations::Vector6 slope;
      slope << a, arm.cross(a);
      squared += information * a.dot(residual) * a.dot(residual);
      one.information += information * slope * slope.transpose();
      one.gradient += information * a.dot(residual) * slope;
    }
    const double over = 1.0 + squared / (kernel * kernel);
    sums.information += one.information / (over * over);
    sums.gradient += one.gradient / (over * over);
    sums.cost += squared / over;
    ++sums.met;
    if (squared > 9.0) continue;
    ++sums.near;
    sums.near_squared += squared;
  }
  return sums;
}

TEST(ResidualBatch, IsTheSumOfItsResidualsHoweverManyThereAre) {
  Random random(7);
  ResidualBatch batch;  // the same for all: what was in it before does not show
  for (std::size_t size = 0; size <= ResidualBatch::kCapacity; ++size) {
    std::vector<Meeting> meetings;
    for (std::size_t i = 0; i < size; ++i) meetings.push_back(anyMeeting(random));
    const Pose pose = anyPose(random);
    const double blur_squared = 0.1 * random.uniform(), kernel = 1.0 + random.uniform();
    for (const auto& [gaussian, target] : meetings) {
      ASSERT_FALSE(batch.isFull());
      batch.add(gaussian, target);
    }
    EXPECT_EQ(batch.isFull(), size == ResidualBatch::kCapacity);
    const NormalEquations fast = batch.sumUp(pose.rotation.toRotationMatrix(), pose.translation, blur_squared, kernel);
    const NormalEquations plain = plainSumOf(meetings, pose, blur_squared, kernel);
    EXPECT_LE((fast.information - plain.information).norm(), 1e-12 * plain.information.norm()) << size;
    EXPECT_LE((fast.gradient - plain.gradient).norm(), 1e-11 * plain.information.norm()) << size;
    EXPECT_NEAR(fast.cost, plain.cost, 1e-12 * (1.0 + plain.cost)) << size;
    EXPECT_NEAR(fast.near_squared, plain.near_squared, 1e-12 * (1.0 + plain.cost)) << size;
    EXPECT_EQ(fast.met, size);
    EXPECT_EQ(fast.near, plain.near) << size;
    EXPECT_TRUE(size < 20 || (plain.near > 0 && plain.near < size)) << "both kinds are there";
  }
}

TEST(ResidualBatch, HasTheInformationOfALinearProblem) {
  // Without a kernel the cost is quadratic in the translation: its second differences are twice the information.
  Random random(2);
  const MapGaussian target{direction(random), anyRotation(random), {0.01, 0.2, 0.5}, {1.0, 0.4, 0.1}};
  const Gaussian<3> gaussian{direction(random), Vector<3>(0.1, 0.2, 0.3).asDiagonal(), 1.0};
  const Pose pose = anyPose(random);
  const auto at = [&](const Pose& where) { return sumOf({{gaussian, target}}, where, 0.02, 1e9); };
  constexpr double kStep = 0.1;
  const NormalEquations here = at(pose);
  for (int axis = 0; axis < 3; ++axis) {
    const NormalEquations::Vector6 step = kStep * NormalEquations::Vector6::Unit(axis);
    const double bend = (at(moved(pose, step)).cost - 2.0 * here.cost + at(moved(pose, -step)).cost) / (kStep * kStep);
    EXPECT_NEAR(here.information(axis, axis), 0.5 * bend, 1e-8 * bend);
  }
  const Eigen::Matrix3d slope_of_arm = here.information.topRightCorner<3, 3>();
  const Eigen::Vector3d arm = pose.rotation * gaussian.mean;
  const Eigen::Matrix3d straight = here.information.topLeftCorner<3, 3>();
  for (int axis = 0; axis < 3; ++axis)  // a turn about `axis` moves the point by axis x arm
    EXPECT_LT((slope_of_arm.col(axis) - straight * Eigen::Vector3d::Unit(axis).cross(arm)).norm(), 1e-9);
}

TEST(ResidualBatch, KnowsNothingAlongAnAxisThatFillsItsCell) {
  const MapGaussian wall{{0, 0, 0}, Matrix<3>::Identity(), {0.0004, 0.0833, 0.0833}, {1.0, 0.0, 0.0}};
  const NormalEquations sums = sumOf({{{{0.04, 0.3, -0.2}, Matrix<3>::Zero(), 1.0}, wall}}, Pose(), 0.0012, 1e9);
  EXPECT_NEAR(sums.cost, 0.04 * 0.04 / 0.0016, 1e-12);  // across the wall only
  EXPECT_NEAR(sums.information(0, 0), 1.0 / 0.0016, 1e-9);
  EXPECT_EQ(sums.information(1, 1), 0.0);
}

TEST(ResidualBatch, HearsHalfOfAResidualAtTheKernel) {
  const MapGaussian ball{{0, 0, 0}, Matrix<3>::Identity(), {1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}};
  const NormalEquations sums = sumOf({{{{3.0, 0.0, 0.0}, Matrix<3>::Zero(), 1.0}, ball}}, Pose(), 0.0, 3.0);
  EXPECT_NEAR(sums.cost, 4.5, 1e-12);
  EXPECT_NEAR(sums.information(1, 1), 0.25, 1e-12);  // (1 / (1 + 1))^2
}

}  // namespace
}  // namespace gaussmap
