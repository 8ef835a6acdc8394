// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/segment_fitter.h"

#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "pcl/scan_cloud.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
/// A user's own point type.
struct EIGEN_ALIGN16 BeamPoint {
  PCL_ADD_POINT4D;
  float echo;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
#pragma GCC diagnostic pop

namespace gaussmap {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<SimulatedScan> planScans(int count) {
  const Simulation plan = makeSimulation(WorldName::Plan, {count, false});
  std::vector<SimulatedScan> scans;
  for (std::size_t i = 0; i < plan.trajectory.size(); ++i) scans.push_back(simulateScan(plan, i));
  return scans;
}

void expectSameMap(const SegmentMap& a, const SegmentMap& b) {
  ASSERT_EQ(a.segments.size(), b.segments.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    EXPECT_EQ(a.segments[i].start, b.segments[i].start);
    EXPECT_EQ(a.segments[i].end, b.segments[i].end);
  }
}

template <typename PointT>
SegmentMap mapThroughPcl(const std::vector<SimulatedScan>& scans) {
  PointCloudSegmentFitter<PointT> fitter;
  for (const SimulatedScan& scan : scans) {
    fitter.setInputCloud(cloudOf<PointT>(scan));
    EXPECT_GT(fitter.fit().beams, 100u);
  }
  return fitter.map();
}

TEST(PointCloudSegmentFitter, MakesTheMapOfTheCore) {
  const std::vector<SimulatedScan> scans = planScans(12);
  SegmentFitter core;
  for (const SimulatedScan& scan : scans) {
    const auto cloud = cloudOf<pcl::PointXYZ>(scan);  // floats, as PCL has them
    Scan same{{}, {}, 0};
    same.pose.translation = cloud->sensor_origin_.head<3>().cast<double>();
    same.pose.rotation = cloud->sensor_orientation_.cast<double>();
    same.pose = normalised(same.pose);
    for (const pcl::PointXYZ& point : *cloud) same.points.push_back(point.getVector3fMap().cast<double>());
    core.add(planarScan(same));
  }
  ASSERT_GT(core.map().segments.size(), 5u);
  expectSameMap(mapThroughPcl<pcl::PointXYZ>(scans), core.map());
}

TEST(PointCloudSegmentFitter, TakesTheUtilityTheSensorModelAndTheObserverOfTheUser) {
  // A sensor without noise, a utility that splits near the observer only.
  struct Exact : ObservationModel {
    void observe(const LaserScan& scan, std::size_t beam, std::uint64_t,
                 std::vector<ObservationPoint>& points) const override {
      points = {{scan.hit(beam), 1.0}};
    }
  };
  struct Near : UserUtility {
    Vector<2> observer{1e6, 0.0};
    bool free = false;  // true: the sensor does not move the observer
    double split(const SegmentGoals& whole, const SegmentGoals&, const SegmentGoals&) const override {
      return (0.5 * (whole.start + whole.end) - observer).norm() < 6.0 ? whole.length : 0.0;
    }
    double nothing(const SegmentGoals&) const override { return 1.0; }
    void observe(const Vector<2>& position) override {
      if (free) observer = position;
    }
    bool reconsider(const Vector<2>&, const Vector<2>&) const override { return free; }
  };
  const auto utility = std::make_shared<Near>();
  PointCloudSegmentFitter<pcl::PointXYZ> fitter({}, utility, std::make_shared<Exact>());
  const SimulatedScan scan = planScans(1).front();
  fitter.setInputCloud(cloudOf<pcl::PointXYZ>(scan));
  const std::size_t before = fitter.fit().segments;
  for (const Segment& segment : fitter.map().segments) EXPECT_TRUE(std::isfinite(segment.normal_variance));
  utility->free = true;
  const SegmentStatistics step = fitter.observe(scan.pose.translation.head<2>());
  EXPECT_GT(step.splits, 0u);
  EXPECT_EQ(step.segments, before + step.splits);
}

TEST(PointCloudSegmentFitter, TakesAnyPointType) {
  const std::vector<SimulatedScan> scans = planScans(4);
  expectSameMap(mapThroughPcl<BeamPoint>(scans), mapThroughPcl<pcl::PointXYZ>(scans));
  expectSameMap(mapThroughPcl<pcl::PointXYZI>(scans), mapThroughPcl<pcl::PointXYZ>(scans));
}

TEST(PointCloudSegmentFitter, CountsOnlyThePointsOfItsIndices) {
  const SimulatedScan scan = planScans(1).front();
  auto cloud = cloudOf<pcl::PointXYZ>(scan);
  auto half = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < cloud->size() / 2; ++i) half->push_back(static_cast<pcl::index_t>(i));
  PointCloudSegmentFitter<pcl::PointXYZ> some, cut;
  some.setInputCloud(cloud);
  some.setIndices(half);
  const SegmentStatistics statistics = some.fit();
  cloud->resize(half->size());
  cut.setInputCloud(cloud);
  EXPECT_EQ(statistics.beams, cut.fit().beams);
  expectSameMap(some.map(), cut.map());
}

TEST(PointCloudSegmentFitter, LeavesOutPointsThatAreNone) {
  auto cloud = cloudOf<pcl::PointXYZ>(planScans(1).front());
  PointCloudSegmentFitter<pcl::PointXYZ> fitter;
  const std::size_t returns = static_cast<std::size_t>(
      std::count_if(cloud->begin(), cloud->end(), [](const auto& p) { return std::isfinite(p.x); }));
  for (std::size_t i = 20; i < 30; ++i) (*cloud)[i].x = (*cloud)[i].y = (*cloud)[i].z = kNan;
  fitter.setInputCloud(cloud);
  EXPECT_EQ(fitter.fit().beams, returns - 10);
}

TEST(PointCloudSegmentFitter, ChangesNothingForACloudThatItCannotTake) {
  PointCloudSegmentFitter<pcl::PointXYZ> fitter;
  EXPECT_EQ(fitter.fit().beams, 0u);  // no cloud
  fitter.setInputCloud(pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>());
  EXPECT_EQ(fitter.fit().beams, 0u);
  auto high = cloudOf<pcl::PointXYZ>(planScans(1).front());
  (*high)[3].z = 7.0f;  // in no plane
  fitter.setInputCloud(high);
  EXPECT_EQ(fitter.fit().beams, 0u);
  auto lost = cloudOf<pcl::PointXYZ>(planScans(1).front());
  lost->sensor_origin_.x() = kNan;
  fitter.setInputCloud(lost);
  EXPECT_EQ(fitter.fit().beams, 0u);
  EXPECT_TRUE(fitter.map().segments.empty());
  EXPECT_EQ(fitter.fitter().scans(), 0u);
}

TEST(PointCloudSegmentFitter, TakesASliceOfASpace) {
  auto cloud = cloudOf<pcl::PointXYZ>(planScans(1).front());
  const std::size_t count = cloud->size();
  for (std::size_t i = 0; i < count; ++i) {
    pcl::PointXYZ above = (*cloud)[i];
    above.z += 2.0f;
    cloud->push_back(above);
  }
  PlanarScanOptions slice;
  slice.slice = true;
  slice.z_min = -0.5;
  slice.z_max = 0.5;
  PointCloudSegmentFitter<pcl::PointXYZ> fitter;
  fitter.setPlanarScan(slice);
  fitter.setInputCloud(cloud);
  EXPECT_GT(fitter.fit().beams, 100u);
  EXPECT_FALSE(fitter.map().segments.empty());
}

TEST(PointCloudSegmentFitter, TellsWhichPointsLieOnWhichSegment) {
  const std::vector<SimulatedScan> scans = planScans(6);
  PointCloudSegmentFitter<pcl::PointXYZ> fitter;
  for (const SimulatedScan& scan : scans) {
    fitter.setInputCloud(cloudOf<pcl::PointXYZ>(scan));
    fitter.fit();
  }
  const auto cloud = cloudOf<pcl::PointXYZ>(scans.back());
  fitter.setInputCloud(cloud);
  std::vector<pcl::PointIndices> segments;
  fitter.segmentIndices(segments);
  const SegmentMap map = fitter.map();
  ASSERT_EQ(segments.size(), map.segments.size());
  const Eigen::Quaterniond rotation = cloud->sensor_orientation_.cast<double>();
  std::vector<int> owner(cloud->size(), -1);
  for (std::size_t s = 0; s < segments.size(); ++s)
    for (const auto i : segments[s].indices) owner[std::size_t(i)] = int(s);
  std::size_t owned = 0, returned = 0;
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    if (!std::isfinite((*cloud)[i].x)) {
      EXPECT_EQ(owner[i], -1);
      continue;
    }
    ++returned;
    const Eigen::Vector3d p =
        rotation * (*cloud)[i].getVector3fMap().cast<double>() + cloud->sensor_origin_.head<3>().cast<double>();
    double least = 0.1;
    int nearest = -1;
    for (std::size_t s = 0; s < map.segments.size(); ++s)
      if (map.segments[s].distance({p.x(), p.y()}) < least) {
        least = map.segments[s].distance({p.x(), p.y()});
        nearest = int(s);
      }
    EXPECT_EQ(owner[i], nearest);
    owned += owner[i] >= 0;
  }
  EXPECT_GT(owned, returned * 9 / 10);
  PointCloudSegmentFitter<pcl::PointXYZ> none;
  none.segmentIndices(segments);
  EXPECT_TRUE(segments.empty());
}

}  // namespace
}  // namespace gaussmap
