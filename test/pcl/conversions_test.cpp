// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/conversions.h"

#include <gtest/gtest.h>
#include <pcl/filters/passthrough.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <limits>

#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/mapping/refine.h"
#include "io/files/temporary_directory.h"
#include "map/random_clouds.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
/// A user's own point type.
struct EIGEN_ALIGN16 StrangersPoint {
  PCL_ADD_POINT4D;
  float colour;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
#pragma GCC diagnostic pop

namespace gaussmap {
namespace {

GaussianMapOctree refinedMap() {
  return refine<3>(build<3>(test::randomCloud<3>(4000, 31), {0.1, 5, 3, 0.0})).map;
}

TEST(PointGaussian, ComesOutOfAnExportedFileThroughPcl) {
  const test::TemporaryDirectory folder;
  const GaussianMapOctree map = refinedMap();
  const std::string path = (folder.path() / "map.pcd").string();
  savePcd(path, map);
  pcl::PointCloud<PointGaussian> read;
  ASSERT_EQ(pcl::io::loadPCDFile(path, read), 0);
  const pcl::PointCloud<PointGaussian> expected = toPointCloud(map);
  ASSERT_EQ(read.size(), expected.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].getVector3fMap(), expected[i].getVector3fMap());
    for (int element = 0; element < 6; ++element)
      EXPECT_EQ(read[i].covariance[element], expected[i].covariance[element]);
    EXPECT_EQ(read[i].weight, expected[i].weight);
    EXPECT_EQ(read[i].occupancy, 10.0f);
    EXPECT_EQ(read[i].cell_side, expected[i].cell_side);
    EXPECT_EQ(read[i].scale, expected[i].scale);
    EXPECT_EQ(read[i].cell_x, expected[i].cell_x);
    EXPECT_EQ(read[i].cell_y, expected[i].cell_y);
    EXPECT_EQ(read[i].cell_z, expected[i].cell_z);
  }
}

TEST(PointGaussian, WrittenByPclIsReadAsAMap) {
  const test::TemporaryDirectory folder;
  const GaussianMapOctree map = refinedMap();
  for (const bool compressed : {false, true}) {
    const std::string path = (folder.path() / (compressed ? "compressed.pcd" : "binary.pcd")).string();
    compressed ? pcl::io::savePCDFileBinaryCompressed(path, toPointCloud(map))
               : pcl::io::savePCDFileBinary(path, toPointCloud(map));
    const GaussianMapOctree read = loadAny(path);
    for (int s = 0; s < map.scales(); ++s) {
      EXPECT_EQ(read.scale(s).keys, map.scale(s).keys);
      EXPECT_EQ(read.gaussianCount(s), map.gaussianCount(s));
    }
  }
}

TEST(PointGaussian, PassesThroughAFilterOnItsScale) {
  const GaussianMapOctree map = refinedMap();
  pcl::PassThrough<PointGaussian> filter;
  filter.setInputCloud(toPointCloud(map).makeShared());
  filter.setFilterFieldName("scale");
  filter.setFilterLimits(1.0f, 1.0f);
  pcl::PointCloud<PointGaussian> middle;
  filter.filter(middle);
  EXPECT_EQ(middle.size(), map.gaussianCount(1));
  for (const PointGaussian& point : middle) EXPECT_EQ(point.scale, 1);
}

TEST(PointGaussian, GoesBackToAMapAtOnce) {
  const GaussianMapOctree map = refinedMap(), back = fromPointCloud(toPointCloud(map));
  for (int s = 0; s < map.scales(); ++s) {
    ASSERT_EQ(back.gaussianCount(s), map.gaussianCount(s));
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i)
      EXPECT_LT((back.gaussian(i, s).mean - map.gaussian(i, s).mean).norm(), 1e-6);
  }
}

TEST(BuildMap, TakesUsualPointTypesAndAStrangersOwn) {
  const std::vector<Vector<3>> points = test::randomCloud<3>(2000, 32);
  pcl::PointCloud<pcl::PointXYZ> plain;
  pcl::PointCloud<pcl::PointXYZRGBNormal> rich;
  pcl::PointCloud<StrangersPoint> own;
  for (const Vector<3>& p : points) {
    const Eigen::Vector3f f = p.cast<float>();
    plain.emplace_back(f.x(), f.y(), f.z());
    pcl::PointXYZRGBNormal point;
    point.getVector3fMap() = f;
    rich.push_back(point);
    StrangersPoint strange;
    strange.getVector3fMap() = f;
    own.push_back(strange);
  }
  const GaussianMapOctree expected = buildMap(plain);
  EXPECT_EQ(buildMap(rich).scale(0).moments, expected.scale(0).moments);
  EXPECT_EQ(buildMap(own).scale(0).moments, expected.scale(0).moments);
  EXPECT_EQ(expected.weight(2), 2000.0);
}

Scan anOrganisedScan() {
  Scan scan;
  scan.columns = 4;
  for (int i = 0; i < 12; ++i) scan.points.emplace_back(0.5 * i, -0.25 * i, 1.0);
  scan.points[5].setConstant(std::numeric_limits<double>::quiet_NaN());
  scan.pose.translation << 1.5, -2.25, 0.5;
  scan.pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  scan.time = 1700000000.123457;
  return scan;
}

TEST(ScanConversion, KeepsPointsRowsPoseAndTimeBothWays) {
  const Scan scan = anOrganisedScan();
  const auto cloud = toPointCloud<pcl::PointXYZI>(scan);
  EXPECT_EQ(cloud.width, 4u);
  EXPECT_EQ(cloud.height, 3u);
  EXPECT_FALSE(cloud.is_dense);
  EXPECT_EQ(cloud.header.stamp, 1700000000123457u);
  EXPECT_EQ(cloud.sensor_origin_.head<3>(), Eigen::Vector3f(1.5f, -2.25f, 0.5f));
  EXPECT_EQ(cloud[2].x, 1.0f);
  EXPECT_EQ(cloud[2].intensity, pcl::PointXYZI().intensity);
  const Scan back = toScan(cloud);
  EXPECT_EQ(back.columns, 4);
  ASSERT_EQ(back.points.size(), scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (i == 5)
      EXPECT_TRUE(back.points[i].hasNaN());
    else
      EXPECT_EQ(back.points[i], scan.points[i]);  // these numbers are floats
  }
  EXPECT_EQ(back.pose.translation, scan.pose.translation);
  EXPECT_LT(back.pose.rotation.angularDistance(scan.pose.rotation), 1e-6);
  ASSERT_TRUE(back.time);
  EXPECT_NEAR(*back.time, *scan.time, 1e-6);
  EXPECT_EQ(toPointCloud<pcl::PointXYZI>(back).header.stamp, cloud.header.stamp);
}

TEST(ScanConversion, MakesAListOfAScanWithoutRows) {
  Scan scan = anOrganisedScan();
  scan.columns = 0;
  scan.time.reset();
  scan.points.erase(scan.points.begin() + 5);
  const auto cloud = toPointCloud<pcl::PointXYZ>(scan);
  EXPECT_EQ(cloud.width, 11u);
  EXPECT_EQ(cloud.height, 1u);
  EXPECT_TRUE(cloud.is_dense);
  EXPECT_EQ(cloud.header.stamp, 0u);
  EXPECT_EQ(toScan(cloud).columns, 0);
  EXPECT_FALSE(toScan(cloud).time);
  scan.time = -3.0;  // a stamp cannot be negative
  EXPECT_EQ(toPointCloud<pcl::PointXYZ>(scan).header.stamp, 0u);
}

TEST(ScanConversion, RoundsAHundredMetresToFourMicrometres) {
  Scan scan;
  Random random(7);
  for (int i = 0; i < 1000; ++i)
    scan.points.emplace_back(100.0 * random.uniform(), 100.0 * random.uniform(), 100.0 * random.uniform());
  const auto cloud = toPointCloud<pcl::PointXYZ>(scan);
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    EXPECT_LT((cloud[i].getVector3fMap().cast<double>() - scan.points[i]).cwiseAbs().maxCoeff(), 4e-6);
}

TEST(ScanConversion, RefusesAFaultyPoseAndABrokenRow) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  cloud.sensor_orientation_ = Eigen::Quaternionf(0, 0, 0, 0);
  EXPECT_THROW(toScan(cloud), std::invalid_argument);
  Scan scan = anOrganisedScan();
  scan.columns = 5;
  EXPECT_THROW(toPointCloud<pcl::PointXYZ>(scan), std::invalid_argument);
  EXPECT_TRUE(toPointCloud<pcl::PointXYZ>(Scan()).empty());
  EXPECT_TRUE(toScan(pcl::PointCloud<pcl::PointXYZ>()).points.empty());
}

}  // namespace
}  // namespace gaussmap
