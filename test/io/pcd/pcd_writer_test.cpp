// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/pcd/pcd_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <locale>
#include <string>

#include "gaussmap/io/pcd/pcd_reader.h"

namespace gaussmap {
namespace {

namespace fs = std::filesystem;

struct File {
  std::string header;
  std::string data;
};

class PcdWriterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "gaussmap_pcd_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    path_ = folder_ / "cloud.pcd";
  }
  void TearDown() override { fs::remove_all(folder_); }

  File read() const {
    std::ifstream stream(path_, std::ios::binary);
    const std::string all{std::istreambuf_iterator<char>(stream), {}};
    const std::string end = "DATA binary\n";
    const std::size_t split = all.find(end) + end.size();
    return {all.substr(0, split), all.substr(split)};
  }

  fs::path folder_, path_;
};

template <typename T>
T valueAt(const std::string& data, std::size_t offset) {
  T value;
  std::memcpy(&value, data.data() + offset, sizeof value);
  return value;
}

TEST_F(PcdWriterTest, WritesTheHeaderThatTheFormatAsksFor) {
  writePcd(path_, {{1, 2, 3}, {4, 5, 6}});
  const File file = read();
  EXPECT_EQ(file.header,
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
            "COUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n");
  ASSERT_EQ(file.data.size(), 24u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(valueAt<float>(file.data, 4 * i), float(i + 1));
  EXPECT_FALSE(fs::exists(path_.string() + ".part"));
}

TEST_F(PcdWriterTest, KeepsDoublesToTheLastBit) {
  const Vector<3> point(1e7 + 1.0 / 3.0, -2.0 / 3.0, std::nan(""));
  writePcd(path_, {point}, PcdPrecision::Double);
  const File file = read();
  EXPECT_NE(file.header.find("SIZE 8 8 8\n"), std::string::npos);
  ASSERT_EQ(file.data.size(), 24u);
  EXPECT_EQ(valueAt<double>(file.data, 0), point.x());
  EXPECT_EQ(valueAt<double>(file.data, 8), point.y());
  EXPECT_TRUE(std::isnan(valueAt<double>(file.data, 16)));
}

TEST_F(PcdWriterTest, WritesThePoseExactlyWithTheRealPartFirst) {
  const Pose pose{{691234.0625, -5.1, 0.1}, Pose::Rotation(0.5, -0.5, 0.5, 0.5)};
  writePcd(path_, {{1, 2, 3}}, PcdPrecision::Float, pose);
  EXPECT_NE(read().header.find("VIEWPOINT 691234.0625 -5.0999999999999996 0.10000000000000001 0.5 -0.5 0.5 0.5\n"),
            std::string::npos)
      << read().header;
}

TEST_F(PcdWriterTest, WritesAnyColumnsWithCountsAndStrides) {
  struct Row {
    float x;
    double weight;
  };
  const std::vector<Row> rows = {{1.5f, 10.25}, {2.5f, 20.25}, {3.5f, 30.25}};
  const std::vector<float> covariance = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  const std::vector<std::int32_t> cell = {-1, -2, -3};
  const std::vector<std::uint32_t> scale = {0, 1, 4000000000u};
  const std::vector<std::uint8_t> label = {7, 8, 255};
  writePcd(path_, 3,
           {pcdOutput("x", &rows[0].x, 1, sizeof(Row)), pcdOutput("weight", &rows[0].weight, 1, sizeof(Row)),
            pcdOutput("covariance", covariance.data(), 3), pcdOutput("cell_x", cell.data()),
            pcdOutput("scale", scale.data()), pcdOutput("label", label.data())});
  const File file = read();
  EXPECT_NE(file.header.find("FIELDS x weight covariance cell_x scale label\nSIZE 4 8 4 4 4 1\nTYPE F F F I U U\n"
                             "COUNT 1 1 3 1 1 1\nWIDTH 3\n"),
            std::string::npos)
      << file.header;
  const std::size_t record = 4 + 8 + 12 + 4 + 4 + 1;
  ASSERT_EQ(file.data.size(), 3 * record);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(valueAt<float>(file.data, i * record), rows[i].x);
    EXPECT_EQ(valueAt<double>(file.data, i * record + 4), rows[i].weight);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(valueAt<float>(file.data, i * record + 12 + 4 * k), covariance[3 * i + k]);
    EXPECT_EQ(valueAt<std::int32_t>(file.data, i * record + 24), cell[i]);
    EXPECT_EQ(valueAt<std::uint32_t>(file.data, i * record + 28), scale[i]);
    EXPECT_EQ(valueAt<std::uint8_t>(file.data, i * record + 32), label[i]);
  }
}

TEST_F(PcdWriterTest, WritesWhatTheReaderReads) {
  const std::vector<Vector<3>> points = {{1e7 + 0.1, 2, 3}, {-4, 5e-300, 6}};
  const Pose pose{{7, 8, 9.1}, Pose::Rotation(0.5, 0.5, -0.5, 0.5)};
  writePcd(path_, points, PcdPrecision::Double, pose);
  const PcdReader reader(path_);
  ASSERT_EQ(reader.size(), 2u);
  EXPECT_TRUE(reader.header().has_viewpoint);
  EXPECT_EQ(reader.header().viewpoint.translation, pose.translation);
  EXPECT_EQ(reader.header().viewpoint.rotation.coeffs(), pose.rotation.coeffs());
  PointBlock<3> block;
  reader.read(0, block);
  ASSERT_EQ(block.size, 2u);
  for (std::size_t i = 0; i < 2; ++i)
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(block.coordinate[axis][i], points[i](axis));
}

TEST_F(PcdWriterTest, WritesCloudsLargerThanItsBuffer) {  // 12 bytes a point: 250,000 points are 3 MB
  std::vector<Vector<3>> points(250000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = Vector<3>(double(i), 2.0 * double(i), -double(i));
  writePcd(path_, points);
  const File file = read();
  ASSERT_EQ(file.data.size(), 12 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(valueAt<float>(file.data, 12 * i), float(i));
    ASSERT_EQ(valueAt<float>(file.data, 12 * i + 8), -float(i));
  }
}

TEST_F(PcdWriterTest, WritesAnEmptyCloud) {
  writePcd(path_, std::vector<Vector<3>>());
  EXPECT_NE(read().header.find("WIDTH 0\nHEIGHT 1\n"), std::string::npos);
  EXPECT_TRUE(read().data.empty());
}

TEST_F(PcdWriterTest, DoesNotAskTheLocaleForTheDecimalPoint) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  Pose pose;
  pose.translation.x() = 0.5;
  writePcd(path_, std::vector<Vector<3>>(1234, Vector<3>(1, 2, 3)), PcdPrecision::Float, pose);
  std::locale::global(before);
  EXPECT_NE(read().header.find("WIDTH 1234\nHEIGHT 1\nVIEWPOINT 0.5 0 0 "), std::string::npos) << read().header;
}

TEST_F(PcdWriterTest, RefusesFieldsThatNoFileCanHave) {
  const float value = 1.0f;
  const auto refused = [&](const std::vector<PcdOutput>& fields) {
    EXPECT_THROW(writePcd(path_, 1, fields), std::invalid_argument);
  };
  refused({});
  refused({pcdOutput("", &value)});
  refused({pcdOutput("two words", &value)});
  refused({pcdOutput("line\n", &value)});
  refused({pcdOutput("x", &value), pcdOutput("x", &value)});
  refused({pcdOutput<float>("x", nullptr)});
  refused({pcdOutput("x", &value, 0)});
  refused({{"x", 'D', 4, 1, &value, 0}});
  refused({{"x", 'F', 2, 1, &value, 0}});
  refused({{"x", 'U', 3, 1, &value, 0}});
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(PcdWriterTest, RefusesPosesWithFaultsAndPointsThatDoNotFitIntoFloats) {
  Pose zero;
  zero.rotation.coeffs().setZero();
  EXPECT_THROW(writePcd(path_, {{1, 2, 3}}, PcdPrecision::Float, zero), std::invalid_argument);
  EXPECT_THROW(writePcd(path_, {{1, 2, 3}, {0, 1e39, 0}}), std::invalid_argument);
  EXPECT_NO_THROW(writePcd(path_, {{1, 2, 3}, {0, 1e39, 0}}, PcdPrecision::Double));
}

TEST_F(PcdWriterTest, SaysWhichFolderIsMissing) {
  try {
    writePcd(folder_ / "missing" / "cloud.pcd", {{1, 2, 3}});
    FAIL() << "written to nowhere";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("missing/cloud.pcd"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace gaussmap
