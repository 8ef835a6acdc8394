// SPDX-License-Identifier: BSD-3-Clause
#include "core/ellipsoid_pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gaussmap::test {
using namespace detail;

namespace {

Matrix<3> covarianceOf(const EllipsoidPose& pose) {
  const Matrix<3> root = pose.rotation.toRotationMatrix() * pose.deviations.asDiagonal();
  return root * root.transpose();
}

TEST(EllipsoidPose, RebuildsAnyCovarianceFromAUnitQuaternionAndAscendingDeviations) {
  Random random(3);
  for (int trial = 0; trial < 500; ++trial) {
    Matrix<3> root;
    for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = random.normal();
    if (trial % 3 == 0) root.col(0) *= 1e-4;  // flat
    const Gaussian<3> gaussian{{1, 2, 3}, root * root.transpose(), 1.0};
    const EllipsoidPose pose = ellipsoidPose(gaussian);
    EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-12);
    EXPECT_GE(pose.rotation.w(), 0.0);
    EXPECT_LE(pose.deviations(0), pose.deviations(1));
    EXPECT_LE(pose.deviations(1), pose.deviations(2));
    EXPECT_LT((covarianceOf(pose) - gaussian.cov).norm(), 1e-12 * gaussian.cov.norm());
    EXPECT_GE(pose.normal().z(), 0.0);
  }
}

TEST(EllipsoidPose, TheNormalIsTheAxisOfLeastDeviationPointingUp) {
  const auto normalOf = [](const Vector<3>& variances) {
    return ellipsoidPose({Vector<3>::Zero(), variances.asDiagonal(), 1.0}).normal();
  };
  EXPECT_LT((normalOf({4, 2, 1}) - Vector<3>(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((normalOf({4, 1, 2}) - Vector<3>(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((normalOf({1, 4, 2}) - Vector<3>(1, 0, 0)).norm(), 1e-12);
}

TEST(EllipsoidPose, TakesAPointAndRefusesWhatIsNotFinite) {
  const EllipsoidPose point = ellipsoidPose({Vector<3>::Zero(), Matrix<3>::Zero(), 1.0});
  EXPECT_EQ(point.deviations, Vector<3>::Zero());
  EXPECT_NEAR(point.rotation.norm(), 1.0, 1e-12);
  EXPECT_THROW(ellipsoidPose({Vector<3>::Zero(), Matrix<3>::Constant(std::nan("")), 1.0}), std::domain_error);
}

}  // namespace
}  // namespace gaussmap::test
