// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/pcd/pcd_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "gaussmap/core/gaussian.h"
#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap {
namespace {

using test::bytesOf;
using test::compressedBody;
using test::readAll;
using test::TemporaryDirectory;
using test::xyzHeader;
using Axes = std::vector<std::vector<double>>;

const Axes kTwoPoints = {{1.5, -4.0}, {2.25, 5.0}, {-3.0, 0.125}};

std::string twoRecords() {
  std::string bytes;
  for (std::size_t point = 0; point < 2; ++point)
    for (const std::vector<double>& axis : kTwoPoints) bytes += bytesOf(static_cast<float>(axis[point]));
  return bytes;
}

std::string twoPointsFieldByField() {
  std::string bytes;
  for (const std::vector<double>& axis : kTwoPoints)
    for (const double value : axis) bytes += bytesOf(static_cast<float>(value));
  return bytes;
}

TEST(PcdReader, ReadsTheSamePointsFromAllThreeEncodings) {
  const TemporaryDirectory directory;
  const PcdReader ascii(directory.write("a.pcd", xyzHeader(2, "ascii") + "1.5 2.25 -3\n-4 5 0.125\n"));
  const PcdReader binary(directory.write("b.pcd", xyzHeader(2, "binary") + twoRecords()));
  const PcdReader compressed(
      directory.write("c.pcd", xyzHeader(2, "binary_compressed") + compressedBody(twoPointsFieldByField())));
  EXPECT_EQ(readAll(ascii), kTwoPoints);
  EXPECT_EQ(readAll(binary), kTwoPoints);
  EXPECT_EQ(readAll(compressed), kTwoPoints);
  EXPECT_EQ(ascii.header().encoding, PcdEncoding::Ascii);
  EXPECT_EQ(binary.header().encoding, PcdEncoding::Binary);
  EXPECT_EQ(compressed.header().encoding, PcdEncoding::BinaryCompressed);
}

TEST(PcdReader, ReadsTheViewpoint) {
  const TemporaryDirectory directory;
  const PcdReader reader(directory.write(
      "a.pcd",
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 0\nHEIGHT 1\nVIEWPOINT 1 -2 +3e1 0.5 0.1 0.2 "
      "nan\nPOINTS 0\nDATA binary\n"));
  const PcdHeader& header = reader.header();
  EXPECT_TRUE(header.has_viewpoint);
  EXPECT_EQ(header.viewpoint.translation, Eigen::Vector3d(1, -2, 30));
  EXPECT_EQ(header.viewpoint.rotation.w(), 0.5);
  EXPECT_EQ(header.viewpoint.rotation.x(), 0.1);
  EXPECT_TRUE(std::isnan(header.viewpoint.rotation.z()));
  EXPECT_EQ(reader.size(), 0u);
  EXPECT_TRUE(readAll(reader)[0].empty());
}

TEST(PcdReader, ReadsHeadersOfOldVersions) {
  const TemporaryDirectory directory;
  const PcdReader old(directory.write("a.pcd", "COLUMNS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n"));
  EXPECT_EQ(readAll(old), (Axes{{1}, {2}, {3}}));
  EXPECT_FALSE(old.header().has_viewpoint);
  EXPECT_EQ(old.header().height, 1u);
  const PcdReader sixth(directory.write(
      "b.pcd", "VERSION .6\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n0.1 2 3\n"));
  EXPECT_EQ(readAll(sixth), (Axes{{0.1}, {2}, {3}}));
}

TEST(PcdReader, TakesCommentsBlankLinesAndWindowsLineEndsInAscii) {
  const TemporaryDirectory directory;
  std::string text =
      "# one\n\nVERSION 0.7\n# FIELDS a\nFIELDS x y z\n  SIZE 4 4 4\nTYPE\tF F F\nWIDTH 2\nHEIGHT 1\n"
      "POINTS 2\n#\nDATA ascii\n\n 1 2 3 \n\n\t4 5 6\n\n";
  for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.insert(i, "\r");
  EXPECT_EQ(readAll(PcdReader(directory.write("a.pcd", text))), (Axes{{1, 4}, {2, 5}, {3, 6}}));
}

TEST(PcdReader, NeedsNoLineEndAfterTheLastPoint) {
  const TemporaryDirectory directory;
  EXPECT_EQ(readAll(PcdReader(directory.write("a.pcd", xyzHeader(1, "ascii") + "0 0 7"))), (Axes{{0}, {0}, {7}}));
}

TEST(PcdReader, ReadsEveryWayOfWritingANumber) {
  const TemporaryDirectory directory;
  const Axes axes =
      readAll(PcdReader(directory.write("a.pcd", xyzHeader(3, "ascii") + "nan -NaN inf\n+1.5 -inf 1e-3\n.5 1. -0\n")));
  EXPECT_TRUE(std::isnan(axes[0][0]) && std::isnan(axes[1][0]));
  EXPECT_EQ(axes[2][0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(axes[1][1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(axes[0][1], 1.5);
  EXPECT_EQ(axes[0][2], 0.5);
  EXPECT_EQ(axes[1][2], 1.0);
}

TEST(PcdReader, RoundsAsciiToTheTypeOfTheField) {  // so that an ascii and a binary file give the same map
  const TemporaryDirectory directory;
  const Axes axes = readAll(PcdReader(
      directory.write("a.pcd", "FIELDS x y z\nSIZE 4 8 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n0.1 0.1 1e-300\n")));
  EXPECT_EQ(axes[0][0], double{0.1f});
  EXPECT_EQ(axes[1][0], 0.1);
  EXPECT_EQ(axes[2][0], 0.0);
}

TEST(PcdReader, IgnoresBytesBehindBinaryData) {
  const TemporaryDirectory directory;
  EXPECT_EQ(readAll(PcdReader(directory.write("a.pcd", xyzHeader(2, "binary") + twoRecords() + "tail"))), kTwoPoints);
  const std::string body = compressedBody(twoPointsFieldByField());
  EXPECT_EQ(readAll(PcdReader(directory.write("b.pcd", xyzHeader(2, "binary_compressed") + body + "tail"))),
            kTwoPoints);
}

TEST(PcdReader, ReadsCompressedDataWithAndWithoutThePadding) {  // PCL leaves it out
  const TemporaryDirectory directory;
  const std::string header =
      "FIELDS _ x y z\nSIZE 1 4 4 4\nTYPE U F F F\nCOUNT 3 1 1 1\nPOINTS 2\nDATA binary_compressed\n";
  const PcdReader without(directory.write("a.pcd", header + compressedBody(twoPointsFieldByField())));
  const PcdReader with(directory.write("b.pcd", header + compressedBody("padded" + twoPointsFieldByField())));
  EXPECT_EQ(readAll(without), kTwoPoints);
  EXPECT_EQ(readAll(with), kTwoPoints);
  EXPECT_EQ(without.column("z"), kTwoPoints[2]);
  EXPECT_EQ(with.column("z"), kTwoPoints[2]);
}

TEST(PcdReader, KeepsTheInvalidPointsOfAnOrganisedCloud) {
  const TemporaryDirectory directory;
  const PcdReader reader(
      directory.write("a.pcd",
                      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 2\nPOINTS 4\nDATA ascii\n"
                      "nan nan nan\n1 2 3\nnan nan nan\n4 5 6\n"));
  EXPECT_EQ(reader.size(), 4u);
  EXPECT_EQ(reader.header().width, 2u);
  EXPECT_EQ(reader.header().height, 2u);
  const Axes axes = readAll(reader);
  EXPECT_TRUE(std::isnan(axes[0][2]));
  EXPECT_EQ(axes[2][3], 6.0);
}

TEST(PcdReader, ReadsBlocksFromAnyPoint) {
  const TemporaryDirectory directory;
  const std::size_t points = PointBlock<3>::kCapacity + 3;
  std::string bytes;
  for (std::size_t i = 0; i < 3 * points; ++i) bytes += bytesOf(static_cast<float>(i));
  const PcdReader reader(directory.write("a.pcd", xyzHeader(points, "binary") + bytes));
  PointBlock<3> block;
  reader.read(2, block);
  EXPECT_EQ(block.size, PointBlock<3>::kCapacity);
  EXPECT_EQ(block.coordinate[1][0], 7.0);
  reader.read(points - 1, block);
  EXPECT_EQ(block.size, 1u);
  EXPECT_EQ(block.coordinate[2][0], static_cast<double>(3 * points - 1));
  reader.read(points, block);
  EXPECT_EQ(block.size, 0u);
  reader.read(std::numeric_limits<std::size_t>::max(), block);
  EXPECT_EQ(block.size, 0u);
}

TEST(PcdReader, IsReadByManyThreadsAtOnce) {
  const TemporaryDirectory directory;
  std::string text = xyzHeader(2000, "ascii");
  for (int i = 0; i < 2000; ++i) text += std::to_string(i) + " 1 2\n";
  const PcdReader reader(directory.write("a.pcd", text));
  std::vector<double> sums(4, 0.0);
  std::vector<std::thread> threads;
  for (double& sum : sums)
    threads.emplace_back([&reader, &sum] {
      const Axes axes = readAll(reader);
      for (const double x : axes[0]) sum += x;
    });
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) EXPECT_EQ(sum, 1999.0 * 1000.0);
}

TEST(PcdReader, GivesElementsOfAnyFieldAsColumns) {
  const TemporaryDirectory directory;
  const PcdReader reader(directory.write(
      "a.pcd",
      "FIELDS x y z covariance scale\nSIZE 4 4 4 4 1\nTYPE F F F F I\nCOUNT 1 1 1 6 1\nPOINTS 1\nDATA ascii\n"
      "1 2 3 10 11 12 13 14 15 -7\n"));
  EXPECT_EQ(reader.column("covariance", 4), std::vector<double>{14});
  EXPECT_EQ(reader.columns({{"scale"}, {"covariance", 0}, {"x"}, {"scale"}}), (Axes{{-7}, {10}, {1}, {-7}}));
  EXPECT_THROW(reader.column("weight"), FileError);
  EXPECT_THROW(reader.column("covariance", 6), FileError);
}

TEST(PcdReader, TellsCloudsApartByTheirFingerprints) {
  const TemporaryDirectory directory;
  const std::string header = xyzHeader(2, "binary");
  const PcdReader one(directory.write("a.pcd", header + twoRecords()));
  const PcdReader copy(directory.write("b.pcd", header + twoRecords()));
  const PcdReader other(directory.write("c.pcd", header + std::string(24, '\0')));
  EXPECT_EQ(one.fingerprint(), copy.fingerprint());
  EXPECT_NE(one.fingerprint(), other.fingerprint());
}

TEST(PcdReader, CanBeMoved) {
  const TemporaryDirectory directory;
  std::vector<PcdReader> readers;
  readers.emplace_back(directory.write("a.pcd", xyzHeader(2, "binary") + twoRecords()));
  PcdReader moved = std::move(readers.front());
  EXPECT_EQ(readAll(moved), kTwoPoints);
}

// A random field of a random file, with the bytes of one element and the text that represents it.
struct RandomField {
  std::string name;
  char type;
  std::size_t size;
  std::size_t count;
};

template <typename T>
double put(double value, std::string& bytes, std::string& text) {
  const T rounded = static_cast<T>(value);
  bytes = bytesOf(rounded);
  char digits[64];
  std::snprintf(digits, sizeof(digits), "%.17g", static_cast<double>(rounded));
  text = digits;
  return static_cast<double>(rounded);
}

double putElement(const RandomField& field, Random& random, std::string& bytes, std::string& text) {
  const double value = std::floor(random.uniform() * 120.0);
  const double real = (random.uniform() - 0.5) * 1e3;
  if (field.type == 'F') return field.size == 4 ? put<float>(real, bytes, text) : put<double>(real, bytes, text);
  if (field.type == 'I' && field.size == 1) return put<std::int8_t>(value - 60, bytes, text);
  if (field.type == 'I' && field.size == 2) return put<std::int16_t>(value - 60, bytes, text);
  if (field.type == 'I' && field.size == 4) return put<std::int32_t>(value - 60, bytes, text);
  if (field.type == 'I') return put<std::int64_t>(value - 60, bytes, text);
  if (field.size == 1) return put<std::uint8_t>(value, bytes, text);
  if (field.size == 2) return put<std::uint16_t>(value, bytes, text);
  if (field.size == 4) return put<std::uint32_t>(value, bytes, text);
  return put<std::uint64_t>(value, bytes, text);
}

TEST(PcdReader, ReadsBackRandomFilesExactly) {
  const TemporaryDirectory directory;
  Random random(7);
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random.below(n)); };
  for (int round = 0; round < 300; ++round) {
    std::vector<RandomField> fields;
    for (const char* const axis : {"x", "y", "z"}) fields.push_back({axis, 'F', 4 + 4 * below(2), 1});
    for (std::size_t extra = below(5); extra > 0; --extra) {
      const char type = "IUF"[below(3)];
      const std::size_t size = type == 'F' ? 4 + 4 * below(2) : std::size_t{1} << below(4);
      fields.push_back({below(3) == 0 ? "_" : "f" + std::to_string(extra), type, size, 1 + below(4)});
    }
    for (std::size_t i = fields.size(); i > 1; --i) std::swap(fields[i - 1], fields[below(i)]);

    const std::size_t width = below(60), height = 1 + below(20), points = width * height;
    const std::string encoding = std::vector<std::string>{"ascii", "binary", "binary_compressed"}[below(3)];
    std::string records, text;
    std::vector<std::string> by_field(fields.size());
    std::vector<std::vector<Axes::value_type>> values(fields.size());
    for (std::size_t f = 0; f < fields.size(); ++f) values[f].resize(fields[f].count);
    for (std::size_t point = 0; point < points; ++point) {
      for (std::size_t f = 0; f < fields.size(); ++f) {
        for (std::size_t element = 0; element < fields[f].count; ++element) {
          std::string bytes, digits;
          values[f][element].push_back(putElement(fields[f], random, bytes, digits));
          records += bytes;
          by_field[f] += bytes;
          text += digits + " ";
        }
      }
      text += "\n";
    }
    std::string header = "VERSION 0.7\nFIELDS", sizes = "\nSIZE", types = "\nTYPE", counts = "\nCOUNT", columns;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      header += " " + fields[f].name;
      sizes += " " + std::to_string(fields[f].size);
      types += std::string(" ") + fields[f].type;
      counts += " " + std::to_string(fields[f].count);
      if (fields[f].name != "_") columns += by_field[f];
    }
    header += sizes + types + counts + "\nWIDTH " + std::to_string(width) + "\nHEIGHT " + std::to_string(height) +
              "\nPOINTS " + std::to_string(points) + "\nDATA " + encoding + "\n";
    const PcdReader reader(directory.write("r.pcd", header + (encoding == "ascii"    ? text
                                                              : encoding == "binary" ? records
                                                                                     : compressedBody(columns))));

    const Axes axes = readAll(reader);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (fields[f].name == "_") continue;
      const std::size_t axis = std::string("xyz").find(fields[f].name);
      if (axis < 3) {
        ASSERT_EQ(axes[axis], values[f][0]) << header;
      }
      for (std::size_t element = 0; element < fields[f].count; ++element)
        ASSERT_EQ(reader.column(fields[f].name, element), values[f][element]) << header;
    }
  }
}

}  // namespace
}  // namespace gaussmap
