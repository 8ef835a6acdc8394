// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/ros_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "io/files/hostile_files.h"
#include "io/messages/memory_messages.h"
#include "io/messages/message_scans.h"

namespace gaussmap::detail {
namespace {

using test::complaintOf;
using test::expectComplaint;

std::filesystem::path testMessages() {
#ifdef GAUSSMAP_TEST_DATA
  return std::filesystem::path(GAUSSMAP_TEST_DATA) / "formats/messages/messages.txt";
#else
  return std::filesystem::path(__FILE__).parent_path() / "../../data/formats/messages/messages.txt";
#endif
}

/// A message in all encodings, and the values that the independent writer got.
struct KnownMessage {
  std::string name, type;
  std::map<std::string, std::string> bytes;  // by encoding
  std::vector<std::pair<std::string, std::vector<std::string>>> expected;
};

std::vector<KnownMessage> knownMessages() {
  std::vector<KnownMessage> messages(1);
  std::ifstream file(testMessages());
  std::string line, word, encoding, hex;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    words >> word;
    KnownMessage& message = messages.back();
    if (word == "message") {
      words >> message.name >> message.type >> encoding >> hex;
      std::string& bytes = message.bytes[encoding];
      for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    } else if (word == "expect") {
      std::string key, value;
      words >> key;
      message.expected.emplace_back(key, std::vector<std::string>());
      while (words >> value) message.expected.back().second.push_back(value);
    } else {
      messages.emplace_back();
    }
  }
  messages.pop_back();
  return messages;
}

MessageEncoding encodingOf(const std::string& name) {
  return name == "ros1" ? MessageEncoding::Ros1 : MessageEncoding::Cdr;
}

const MessageOrigin kOrigin{"drive.bag", "/points", std::chrono::nanoseconds(1700000000100000000)};

void expectNumbers(const std::vector<double>& got, const std::vector<std::string>& expected, double tolerance) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (expected[i] == "NaN")
      EXPECT_TRUE(std::isnan(got[i]));
    else
      EXPECT_NEAR(got[i], std::stod(expected[i]), tolerance) << i;
  }
}

void expectScan(const KnownMessage& message, const std::string& encoding, const std::string& bytes) {
  const MessageScanSize size = scanSize(message.type, bytes, encodingOf(encoding), kOrigin);
  const auto reader =
      readScan(message.type, std::vector<char>(bytes.begin(), bytes.end()), encodingOf(encoding), kOrigin);
  const double tolerance = message.type == "sensor_msgs/LaserScan" ? 1e-13 : 0.0;
  PointBlock<3> block;
  reader->read(0, block);
  std::vector<std::string> values = reader->valueNames();
  for (const auto& [key, expected] : message.expected) {
    SCOPED_TRACE(key);
    if (key == "stamp") {
      EXPECT_EQ(stampText(size.header.stamp), expected.at(0));
    } else if (key == "frame") {
      EXPECT_EQ(size.header.frame, expected.at(0) == "-" ? "" : expected.at(0));
    } else if (key == "points") {
      EXPECT_EQ(std::to_string(reader->size()), expected.at(0));
      EXPECT_EQ(size.points, reader->size());
      EXPECT_EQ(block.size, reader->size());
    } else if (key == "columns") {
      EXPECT_EQ(std::to_string(reader->columns()), expected.at(0));
    } else if (key == "x" || key == "y" || key == "z") {
      const double* const axis = block.coordinate[key[0] - 'x'];
      expectNumbers({axis, axis + block.size}, expected, tolerance);
    } else if (reader->size() > 0) {
      ASSERT_FALSE(values.empty());
      EXPECT_EQ(values.front(), key);
      values.erase(values.begin());
      expectNumbers(reader->values(key), expected, tolerance);
    }
  }
  EXPECT_TRUE(values.empty());
}

TEST(RosMessages, OfCloudsTellTheirSizeAtTheirStart) {
  std::size_t enough = 0;
  for (const KnownMessage& message : knownMessages()) {
    if (!isCloudType(message.type)) continue;
    for (const auto& [encoding, bytes] : message.bytes) {
      const MessageScanSize expected = scanSize(message.type, bytes, encodingOf(encoding), kOrigin);
      for (std::size_t size = 0; size <= bytes.size(); ++size) {
        const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(size);
        const auto found = scanSizeOfStart({{bytes.begin(), end}, bytes.size()}, encodingOf(encoding), kOrigin);
        enough += found.has_value() && size < bytes.size();
        EXPECT_TRUE(found || size < bytes.size());
        if (!found) continue;
        EXPECT_EQ(found->points, expected.points);
        EXPECT_EQ(found->header.frame, expected.header.frame);
        EXPECT_EQ(found->header.stamp, expected.header.stamp);
      }
      // The sizes of message and data contradict each other.
      EXPECT_FALSE(scanSizeOfStart({{bytes.begin(), bytes.end()}, bytes.size() + 8}, encodingOf(encoding), kOrigin));
    }
  }
  EXPECT_GT(enough, 0u);
}

void expectPoses(const std::vector<StampedTransform>& got, const KnownMessage& message) {
  ASSERT_EQ(got.size(), message.expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    const std::vector<std::string>& row = message.expected[i].second;
    EXPECT_EQ(stampText(got[i].stamp), row.at(0));
    EXPECT_EQ(got[i].parent, row.at(1));
    EXPECT_EQ(got[i].child, row.at(2) == "-" ? "" : row.at(2));
    const Pose& pose = got[i].pose;
    expectNumbers({pose.translation.x(), pose.translation.y(), pose.translation.z(), pose.rotation.x(),
                   pose.rotation.y(), pose.rotation.z(), pose.rotation.w()},
                  {row.begin() + 3, row.end()}, 0.0);
  }
}

TEST(RosMessages, EqualThoseOfAnIndependentWriterInAllEncodings) {
  const std::vector<KnownMessage> messages = knownMessages();
  ASSERT_EQ(messages.size(), 20u);
  for (const KnownMessage& message : messages) {
    ASSERT_EQ(message.bytes.size(), 5u);
    for (const auto& [encoding, bytes] : message.bytes) {
      SCOPED_TRACE(message.name + " " + encoding);
      if (isScanType(message.type))
        expectScan(message, encoding, bytes);
      else if (isTransformType(message.type))
        expectPoses(decodeTransforms(bytes, encodingOf(encoding), kOrigin), message);
      else
        expectPoses(decodePoses(message.type, bytes, encodingOf(encoding), kOrigin), message);
    }
  }
}

void decodeAny(const KnownMessage& message, const std::string& encoding, const std::string& bytes) {
  if (isScanType(message.type))
    readScan(message.type, std::vector<char>(bytes.begin(), bytes.end()), encodingOf(encoding), kOrigin);
  else if (isTransformType(message.type))
    decodeTransforms(bytes, encodingOf(encoding), kOrigin);
  else
    decodePoses(message.type, bytes, encodingOf(encoding), kOrigin);
}

TEST(RosMessages, AreRefusedIfTheyEndEarlyOrLate) {
  for (const KnownMessage& message : knownMessages())
    for (const auto& known : message.bytes) {
      const std::string &encoding = known.first, &bytes = known.second;
      SCOPED_TRACE(message.name + " " + encoding);
      for (std::size_t size = 0; size < bytes.size(); ++size)
        ASSERT_NE(complaintOf([&] { decodeAny(message, encoding, bytes.substr(0, size)); }), "") << size;
      const std::string late = complaintOf([&] { decodeAny(message, encoding, bytes + std::string(8, 'a')); });
      expectComplaint(late, "drive.bag", {"/points, message recorded at 1700000000.100000000", "bytes follow"});
    }
}

TEST(RosMessages, AreReadOrRefusedWhenDamaged) {
  std::vector<std::string> good;
  std::vector<KnownMessage> messages;
  for (const KnownMessage& message : knownMessages())
    for (const auto& [encoding, bytes] : message.bytes) {
      messages.push_back(message);
      // The number of the message and the encoding in front of its bytes.
      good.push_back(static_cast<char>(messages.size() - 1) + encoding + '\n' + bytes);
    }
  ASSERT_FALSE(messages.empty());
  ASSERT_LE(messages.size(), 256u);
  test::expectMutationsReadOrRefused(good, [&](const std::string& bytes) {
    const std::size_t end = bytes.find('\n');
    if (end == std::string::npos || end == 0) throw FileError("none", "no name");
    const std::size_t number = static_cast<unsigned char>(bytes[0]) % messages.size();
    decodeAny(messages[number], bytes.substr(1, end - 1), bytes.substr(end + 1));
  });
}

TEST(RosMessages, OfOtherKindsOfCdrAreRefused) {
  for (const char kind : {'\2', '\3', '\10', '\13', '\20'}) {
    const std::string message = std::string("\0", 1) + kind + std::string(60, '\0');
    expectComplaint(complaintOf([&] { decodeTransforms(message, MessageEncoding::Cdr, kOrigin); }), "drive.bag",
                    {"/points", "the CDR header is of kind " + std::to_string(static_cast<int>(kind))});
  }
  expectComplaint(complaintOf([&] { decodeTransforms("abcdefgh", MessageEncoding::Other, kOrigin); }), "drive.bag",
                  {"the encoding is unknown"});
  expectComplaint(complaintOf([&] { decodeTransforms("\0\1", MessageEncoding::Cdr, kOrigin); }), "drive.bag",
                  {"expected at least the 4"});
}

TEST(RosMessages, ClaimNoMoreThanTheirSize) {
  using test::WireBytes;
  constexpr std::uint32_t kMany = 0xFFFFFFFF;
  expectComplaint(complaintOf([&] { decodeTransforms(WireBytes().put(kMany).str(), MessageEncoding::Ros1, kOrigin); }),
                  "drive.bag",
                  {"transforms has 4294967295 elements of at least 72 bytes, but the message has only 0 bytes left"});
  const std::string path = WireBytes().header(1.0, "map").put(kMany).zeros(9).str();
  expectComplaint(complaintOf([&] { decodePoses("nav_msgs/Path", path, MessageEncoding::Ros1, kOrigin); }), "drive.bag",
                  {"poses has 4294967295 elements"});
  const std::string text = WireBytes().put(0).put(1).put(2).put(kMany).str();
  expectComplaint(complaintOf([&] { decodeLaser(text, MessageEncoding::Ros1, kOrigin); }), "drive.bag",
                  {"header.frame_id needs 4294967295 bytes, but the message has only 0 left"});
}

TEST(RosMessages, HaveAHeaderIfTheirTypeIsKnown) {
  const std::string imu = test::WireBytes().header(12.5, "imu_link").zeros(3).str();
  const auto header = headerOf("sensor_msgs/Imu", imu, MessageEncoding::Ros1, kOrigin);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->frame, "imu_link");
  EXPECT_EQ(stampText(header->stamp), "12.500000000");
  EXPECT_FALSE(headerOf("std_msgs/String", imu, MessageEncoding::Ros1, kOrigin));
  EXPECT_EQ(stampText(std::chrono::nanoseconds(-1500000000)), "-1.500000000");
}

}  // namespace
}  // namespace gaussmap::detail
