// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/scan.h"

#include <gtest/gtest.h>

#include <limits>

#include "gaussmap/core/error.h"
#include "gaussmap/core/random.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/sensor/projection.h"
#include "io/files/temporary_directory.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

Pose somePose() {
  return normalised({{10, -20, 3}, {0.3, -0.5, 0.7, 0.2}});
}

TEST(LoadScan, KeepsAllPointsInTheirOrder) {
  const test::TemporaryDirectory directory;
  std::vector<Vector<3>> points = test::randomCloud<3>(3000, 1);  // several blocks
  points[700] = Vector<3>::Constant(std::numeric_limits<double>::quiet_NaN());
  points[701] = Vector<3>::Zero();
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, points, PcdPrecision::Double);
  const Scan scan = loadScan({path, somePose()});
  ASSERT_EQ(scan.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_TRUE(i == 700 || scan.points[i] == points[i]);
  EXPECT_FALSE(isReturn(scan.points[700]));
  EXPECT_FALSE(isReturn(scan.points[701]));
  EXPECT_TRUE(isReturn(scan.points[702]));
  EXPECT_EQ(scan.columns, 0);
  EXPECT_EQ(scan.pose.translation, somePose().translation);
}

TEST(LoadScan, MovesPointsOfTheMapIntoTheSensorsFrame) {
  const test::TemporaryDirectory directory;
  const Pose pose = somePose();
  const std::vector<Vector<3>> in_sensor = test::randomCloud<3>(600, 2);
  std::vector<Vector<3>> in_map;
  for (const Vector<3>& point : in_sensor) in_map.push_back(pose.rotation * point + pose.translation);
  in_map.push_back(pose.translation);  // the sensor's own place
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, in_map, PcdPrecision::Double);
  const Scan scan = loadScan({path, pose}, ScanFrame::Map);
  for (std::size_t i = 0; i < in_sensor.size(); ++i) ASSERT_LT((scan.points[i] - in_sensor[i]).norm(), 1e-13);
  EXPECT_FALSE(isReturn(scan.points.back()));
}

TEST(LoadScan, KnowsTheRowsOfAnOrganisedCloud) {
  const test::TemporaryDirectory directory;
  const std::vector<float> numbers(3 * 24, 1.5f);
  const std::size_t stride = 3 * sizeof(float);
  const std::vector<PcdOutput> fields = {pcdOutput("x", &numbers[0], 1, stride), pcdOutput("y", &numbers[1], 1, stride),
                                         pcdOutput("z", &numbers[2], 1, stride)};
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, 24, fields, std::nullopt, 8);
  EXPECT_EQ(loadScan({path, {}}).columns, 8);
  EXPECT_EQ(loadScan({path, {}}).points.size(), 24u);
}

TEST(LoadScan, TakesAScanWithoutPointsAndRefusesAMissingFile) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, std::vector<Vector<3>>{});
  EXPECT_TRUE(loadScan({path, {}}).points.empty());
  EXPECT_THROW(loadScan({directory.path() / "none.pcd", {}}), FileError);
}

}  // namespace
}  // namespace gaussmap
