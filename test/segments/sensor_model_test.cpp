// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/sensor_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace gaussmap {
namespace {

struct Moments {
  Vector<2> mean{0.0, 0.0};
  Matrix<2> covariance = Matrix<2>::Zero();
  double weight = 0.0;
};

Moments momentsOf(const std::vector<ObservationPoint>& points) {
  Moments moments;
  for (const ObservationPoint& point : points) {
    moments.weight += point.weight;
    moments.mean += point.weight * point.position;
  }
  for (const ObservationPoint& point : points) {
    const Vector<2> from = point.position - moments.mean;
    moments.covariance += point.weight * from * from.transpose();
  }
  return moments;
}

LaserScan oneBeam(double bearing, double range, double heading) {
  LaserScan scan;
  scan.pose.translation = {3.0, -1.0};
  scan.pose.heading = heading;
  scan.bearings = {bearing};
  scan.ranges = {range};
  return scan;
}

Matrix<3> poseCovariance() {
  Matrix<3> root;
  root << 0.05, 0.0, 0.0, 0.02, 0.04, 0.0, 0.01, -0.01, 0.03;
  return root * root.transpose();
}

TEST(UnscentedObservations, HaveTheMomentsOfManySamples) {
  for (const bool certain : {true, false}) {
    LaserScan scan = oneBeam(0.4, 5.0, 1.0);
    if (!certain) scan.pose.covariance = poseCovariance();
    const SensorNoise noise{0.05, 0.04};
    std::vector<ObservationPoint> points;
    SampledObservations(noise, 200000, 7).observe(scan, 0, 0, points);
    const Moments sampled = momentsOf(points);
    UnscentedObservations(noise).observe(scan, 0, 0, points);
    const Moments unscented = momentsOf(points);
    EXPECT_NEAR(sampled.weight, 1.0, 1e-9);
    EXPECT_NEAR(unscented.weight, 1.0, 1e-12);
    EXPECT_NEAR((sampled.mean - unscented.mean).norm(), 0.0, 2e-3);
    EXPECT_LT((sampled.covariance - unscented.covariance).norm(), 0.02 * sampled.covariance.norm());
    // The mean lies short of the beam's end: h is not linear.
    EXPECT_GT((scan.hit(0) - unscented.mean).norm(), 3e-3);
  }
}

TEST(UnscentedObservations, WithRangeNoiseAloneSpreadAlongTheBeam) {
  std::vector<ObservationPoint> points;
  UnscentedObservations({0.1, 0.0}).observe(oneBeam(0.0, 2.0, 0.0), 0, 0, points);
  const Moments moments = momentsOf(points);
  EXPECT_NEAR(moments.mean.x(), 5.0, 1e-12);
  EXPECT_NEAR(moments.mean.y(), -1.0, 1e-12);
  EXPECT_NEAR(moments.covariance(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(moments.covariance(1, 1), 0.0, 1e-12);
}

TEST(ObservationModels, WithoutNoiseGiveTheBeamsEnd) {
  const LaserScan scan = oneBeam(-0.3, 4.0, 2.0);
  std::vector<ObservationPoint> points;
  const SampledObservations sampled({0.0, 0.0}, 3, 1);
  const UnscentedObservations unscented({0.0, 0.0});
  for (const ObservationModel* model :
       {static_cast<const ObservationModel*>(&sampled), static_cast<const ObservationModel*>(&unscented)}) {
    model->observe(scan, 0, 5, points);
    EXPECT_FALSE(points.empty());
    for (const ObservationPoint& point : points) EXPECT_NEAR((point.position - scan.hit(0)).norm(), 0.0, 1e-12);
  }
}

TEST(SampledObservations, AreTheSameForTheSameSeedAndNumberOnly) {
  const LaserScan scan = oneBeam(0.1, 4.0, 0.0);
  std::vector<ObservationPoint> a, b;
  SampledObservations({}, 5, 1).observe(scan, 0, 3, a);
  SampledObservations({}, 5, 1).observe(scan, 0, 3, b);
  ASSERT_EQ(a.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(a[i].position, b[i].position);
  SampledObservations({}, 5, 1).observe(scan, 0, 4, b);
  EXPECT_NE(a[0].position, b[0].position);
  SampledObservations({}, 5, 2).observe(scan, 0, 3, b);
  EXPECT_NE(a[0].position, b[0].position);
}

TEST(SampledObservations, TakeASingularPoseCovariance) {
  LaserScan scan = oneBeam(0.0, 1.0, 0.0);
  scan.pose.covariance(1, 1) = 0.04;  // y alone
  std::vector<ObservationPoint> points;
  SampledObservations({0.0, 0.0}, 20000, 1).observe(scan, 0, 0, points);
  const Moments moments = momentsOf(points);
  EXPECT_NEAR(moments.covariance(0, 0), 0.0, 1e-12);
  EXPECT_NEAR(moments.covariance(1, 1), 0.04, 2e-3);
}

TEST(ObservationModels, RefuseNoiseThatIsNone) {
  EXPECT_THROW(SampledObservations({-0.1, 0.0}), std::invalid_argument);
  EXPECT_THROW(SampledObservations({0.1, 0.1}, 0), std::invalid_argument);
  EXPECT_THROW(UnscentedObservations({0.1, std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
