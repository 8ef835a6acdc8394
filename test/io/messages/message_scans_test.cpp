// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/message_scans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "io/files/hostile_files.h"
#include "io/messages/memory_messages.h"

namespace gaussmap::detail {
namespace {

using test::CloudBytes;
using test::WireBytes;

const MessageOrigin kOrigin{"drive.bag", "/points", std::chrono::nanoseconds(1700000000100000000)};

std::unique_ptr<ScanReader> readerOf(const std::string& bytes, const std::string& type = "sensor_msgs/PointCloud2") {
  return readScan(type, std::vector<char>(bytes.begin(), bytes.end()), MessageEncoding::Ros1, kOrigin);
}

std::string complaintAfter(const std::function<void(CloudBytes&)>& change) {
  CloudBytes cloud;
  change(cloud);
  return test::complaintOf([&] { readerOf(cloud.at(1.0)); });
}

TEST(MessageScans, RefuseALayoutThatContradictsTheData) {
  test::expectComplaint(complaintAfter([](CloudBytes& cloud) { cloud.width = 3; }), "drive.bag",
                        {"/points, message recorded at 1700000000.100000000: the data have 24 bytes, which contradicts "
                         "width 3, height 1, point_step 12 and row_step 24"});
  for (const auto& change : std::vector<std::function<void(CloudBytes&)>>{
           [](CloudBytes& cloud) { cloud.width = 1, cloud.row_step = 12; }, [](CloudBytes& cloud) { cloud.height = 2; },
           [](CloudBytes& cloud) { cloud.width = 0xFFFFFFFF; },
           [](CloudBytes& cloud) { cloud.width = cloud.height = cloud.point_step = cloud.row_step = 0xFFFFFFFF; },
           [](CloudBytes& cloud) { cloud.point_step = 0; }, [](CloudBytes& cloud) { cloud.point_step = 13; },
           [](CloudBytes& cloud) { cloud.data.clear(); }, [](CloudBytes& cloud) { cloud.data += "1"; }})
    EXPECT_NE(complaintAfter(change).find("contradicts"), std::string::npos);
  EXPECT_NE(complaintAfter([](CloudBytes& cloud) { cloud.width = 0; }).find("mean no points"), std::string::npos);
}

TEST(MessageScans, RefuseFieldsThatAreNoCoordinates) {
  EXPECT_NE(complaintAfter([](CloudBytes& cloud) { cloud.fields.pop_back(); }).find("no field 'z', its fields are x y"),
            std::string::npos);
  EXPECT_NE(complaintAfter([](CloudBytes& cloud) { cloud.fields[0].first = "y"; }).find("no field 'x'"),
            std::string::npos);
  EXPECT_NE(complaintAfter([](CloudBytes& cloud) {
              cloud.fields.push_back({"x", 0});
            }).find("'x' occurs twice"),
            std::string::npos);
  EXPECT_NE(complaintAfter([](CloudBytes& cloud) { cloud.datatype = 5; }).find("'x' is int32"), std::string::npos);
  EXPECT_NE(complaintAfter([](CloudBytes& cloud) { cloud.datatype = 9; }).find("datatype 9, expected 1 to 8"),
            std::string::npos);
  EXPECT_NE(complaintAfter([](CloudBytes& cloud) { cloud.datatype = 0; }).find("datatype 0"), std::string::npos);
  EXPECT_NE(
      complaintAfter([](CloudBytes& cloud) { cloud.count = 0xFFFFFFFF; }).find("of a point, but point_step is 12"),
      std::string::npos);
  EXPECT_NE(complaintAfter([](CloudBytes& cloud) { cloud.fields[2].second = 0xFFFFFFFF; }).find("field 'z' ends at"),
            std::string::npos);
}

TEST(MessageScans, AcceptHarmlessFaultsOfDrivers) {
  EXPECT_EQ(complaintAfter([](CloudBytes& cloud) { cloud.row_step = 0; }), "");
  EXPECT_EQ(complaintAfter([](CloudBytes& cloud) { cloud.count = 0; }), "");
  EXPECT_EQ(complaintAfter([](CloudBytes& cloud) {
              cloud.height = 2;
              cloud.width = 1;  // row_step is the size of all rows
            }),
            "");
  EXPECT_EQ(complaintAfter([](CloudBytes& cloud) {  // the padding after the last row is missing
              cloud.height = 2;
              cloud.width = 1;
              cloud.row_step = 16;
              cloud.data.resize(28);
            }),
            "");
  CloudBytes empty;
  empty.width = 0;
  empty.data.clear();
  empty.fields.clear();
  EXPECT_EQ(readerOf(empty.at(1.0))->size(), 0u);
}

TEST(MessageScans, ReadAnyBlockOfACloudWithPaddedRows) {
  CloudBytes cloud;
  cloud.width = 100;
  cloud.height = 30;
  cloud.row_step = 100 * 12 + 8;
  cloud.data.assign(std::size_t{cloud.row_step} * cloud.height, '\x7f');
  for (std::size_t i = 0; i < 3000; ++i) {
    const float xyz[3] = {static_cast<float>(i), static_cast<float>(2 * i), -1.0f};
    std::memcpy(cloud.data.data() + i / 100 * cloud.row_step + i % 100 * 12, xyz, 12);
  }
  const auto reader = readerOf(cloud.at(1.0));
  EXPECT_EQ(reader->columns(), 100);
  for (const std::size_t first : {0u, 1u, 99u, 100u, 512u, 2500u, 2999u}) {
    PointBlock<3> block;
    reader->read(first, block);
    ASSERT_EQ(block.size, std::min<std::size_t>(512, 3000 - first));
    for (std::size_t i = 0; i < block.size; ++i) {
      ASSERT_EQ(block.coordinate[0][i], static_cast<double>(first + i));
      ASSERT_EQ(block.coordinate[1][i], 2.0 * static_cast<double>(first + i));
    }
  }
  PointBlock<3> block;
  reader->read(3000, block);
  EXPECT_EQ(block.size, 0u);
  EXPECT_THROW(reader->values("intensity"), std::out_of_range);
}

TEST(MessageScans, ListFewValuesOfAHostileCloud) {
  CloudBytes cloud;
  cloud.width = 1;
  cloud.point_step = cloud.row_step = 60000;
  cloud.data.assign(60000, '\0');
  for (int i = 0; i < 3000; ++i) cloud.fields.push_back({i % 2 == 0 ? "same" : "v" + std::to_string(i), 0});
  EXPECT_LE(readerOf(cloud.at(1.0))->valueNames().size(), 256u);
}

std::string laserBytes(float least, float most, const std::vector<float>& ranges) {
  WireBytes bytes;
  bytes.header(1.0, "laser");
  for (const float value : {0.0f, 1.0f, 0.5f, 0.0f, 0.1f, least, most}) bytes.put(value);
  bytes.put(static_cast<std::uint32_t>(ranges.size()));
  for (const float range : ranges) bytes.put(range);
  return bytes.put(std::uint32_t{0}).str();
}

TEST(MessageScans, UseAllRangesWithoutLimits) {
  const std::string bytes = laserBytes(0.0f, 0.0f, {1.0f, -1.0f, 1000.0f});
  EXPECT_FALSE(scanSize("sensor_msgs/LaserScan", bytes, MessageEncoding::Ros1, kOrigin).has_range_limits);
  PointBlock<3> block;
  readerOf(bytes, "sensor_msgs/LaserScan")->read(0, block);
  EXPECT_EQ(block.coordinate[0][0], 1.0);
  EXPECT_TRUE(std::isnan(block.coordinate[0][1]));
  EXPECT_NEAR(block.coordinate[0][2], 1000.0 * std::cos(1.0), 1e-9);
}

TEST(MessageScans, RefuseChannelsThatDoNotFitThePoints) {
  const std::string bytes = WireBytes()
                                .header(1.0, "lidar")
                                .put(std::uint32_t{1})
                                .put(1.0f)
                                .put(2.0f)
                                .put(3.0f)
                                .put(std::uint32_t{1})
                                .text("intensity")
                                .put(std::uint32_t{0})
                                .str();
  test::expectComplaint(test::complaintOf([&] { readerOf(bytes, "sensor_msgs/PointCloud"); }), "drive.bag",
                        {"channel 'intensity' has 0 values for 1 points"});
}

}  // namespace
}  // namespace gaussmap::detail
