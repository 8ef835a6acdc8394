// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "io/files/temporary_directory.h"

// The reader beside PCL's own, on files that PCL wrote.
namespace gaussmap {
namespace {

template <typename PointT>
void fillExtras(PointT&, Random&) {}
void fillExtras(pcl::PointXYZI& point, Random& random) {
  point.intensity = static_cast<float>(random.uniform());
}
void fillExtras(pcl::PointXYZRGBNormal& point, Random& random) {
  point.r = static_cast<std::uint8_t>(random.below(256));
  point.normal_x = static_cast<float>(random.normal());
  point.curvature = static_cast<float>(random.uniform());
}

template <typename PointT>
pcl::PointCloud<PointT> randomCloud(std::uint32_t width, std::uint32_t height) {
  Random random(width);
  pcl::PointCloud<PointT> cloud(width, height);
  cloud.sensor_origin_ = {1.5f, -2.0f, 0.25f, 0.0f};
  cloud.sensor_orientation_ = Eigen::Quaternionf(0.5f, -0.5f, 0.5f, -0.5f);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    PointT& point = cloud[i];
    for (int axis = 0; axis < 3; ++axis)
      point.data[axis] =
          i % 7 == 3 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(random.normal() * 30);
    fillExtras(point, random);
  }
  return cloud;
}

bool isSame(double a, float b) {
  return a == static_cast<double>(b) || (std::isnan(a) && std::isnan(b));
}

template <typename PointT>
void expectSameAsPcl(const std::filesystem::path& path) {
  pcl::PointCloud<PointT> twin;
  ASSERT_EQ(pcl::io::loadPCDFile(path.string(), twin), 0);
  const PcdReader reader(path);
  ASSERT_EQ(reader.size(), twin.size());
  EXPECT_EQ(reader.header().width, twin.width);
  EXPECT_EQ(reader.header().height, twin.height);
  EXPECT_TRUE(reader.header().has_viewpoint);
  EXPECT_EQ(reader.header().viewpoint.translation.cast<float>(), twin.sensor_origin_.template head<3>());
  EXPECT_EQ(reader.header().viewpoint.rotation.coeffs().template cast<float>(), twin.sensor_orientation_.coeffs());
  PointBlock<3> block;
  std::size_t first = 0;
  for (; reader.read(first, block), block.size > 0; first += block.size)
    for (std::size_t i = 0; i < block.size; ++i)
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_TRUE(isSame(block.coordinate[axis][i], twin[first + i].data[axis])) << "point " << first + i;
  EXPECT_EQ(first, twin.size());
}

template <typename PointT>
class PcdReaderTwin : public testing::Test {};
using PointTypes = testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGBNormal>;
TYPED_TEST_SUITE(PcdReaderTwin, PointTypes, );  // the comma: clang misses the variadic argument

TYPED_TEST(PcdReaderTwin, ReadsWhatPclWroteAsPclDoes) {
  const test::TemporaryDirectory directory;
  for (const std::uint32_t height : {1u, 17u}) {
    const auto cloud = randomCloud<TypeParam>(101, height);
    const std::filesystem::path path = directory.path() / ("scan" + std::to_string(height) + ".pcd");
    ASSERT_EQ(pcl::io::savePCDFileASCII(path.string(), cloud), 0);
    expectSameAsPcl<TypeParam>(path);
    ASSERT_EQ(pcl::io::savePCDFileBinary(path.string(), cloud), 0);
    expectSameAsPcl<TypeParam>(path);
    ASSERT_EQ(pcl::io::savePCDFileBinaryCompressed(path.string(), cloud), 0);
    expectSameAsPcl<TypeParam>(path);
  }
}

TYPED_TEST(PcdReaderTwin, ReadsWhatPclWroteWithItsPadding) {  // PCLPointCloud2 keeps the gaps of the point type
  const test::TemporaryDirectory directory;
  const auto cloud = randomCloud<TypeParam>(53, 2);
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  // Out of the order of memory PCL's writer gives padding a negative COUNT, which its reader does not take either.
  std::sort(blob.fields.begin(), blob.fields.end(),
            [](const pcl::PCLPointField& a, const pcl::PCLPointField& b) { return a.offset < b.offset; });
  const std::string path = (directory.path() / "scan.pcd").string();
  pcl::PCDWriter writer;
  ASSERT_EQ(writer.writeASCII(path, blob, cloud.sensor_origin_, cloud.sensor_orientation_), 0);
  expectSameAsPcl<TypeParam>(path);
  ASSERT_EQ(writer.writeBinary(path, blob, cloud.sensor_origin_, cloud.sensor_orientation_), 0);
  expectSameAsPcl<TypeParam>(path);
  ASSERT_EQ(writer.writeBinaryCompressed(path, blob, cloud.sensor_origin_, cloud.sensor_orientation_), 0);
  expectSameAsPcl<TypeParam>(path);
}

TEST(PcdReaderTwinColumns, GiveTheNormalsThatPclWrote) {
  const test::TemporaryDirectory directory;
  const auto cloud = randomCloud<pcl::PointXYZRGBNormal>(40, 1);
  const std::string path = (directory.path() / "scan.pcd").string();
  ASSERT_EQ(pcl::io::savePCDFileBinaryCompressed(path, cloud), 0);
  const auto columns = PcdReader(path).columns({{"curvature"}, {"normal_x"}});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_TRUE(isSame(columns[0][i], cloud[i].curvature));
    EXPECT_TRUE(isSame(columns[1][i], cloud[i].normal_x));
  }
}

}  // namespace
}  // namespace gaussmap
