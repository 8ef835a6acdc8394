// SPDX-License-Identifier: BSD-3-Clause
// Files that an independent writer made, against what two independent readers read, see test/data/formats/e57/make.sh.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "io/e57/e57_bytes.h"
#include "io/e57/e57_file.h"

namespace gaussmap::test {
using namespace detail;

namespace {

std::filesystem::path sample(const std::string& name) {
  return std::filesystem::path(GAUSSMAP_TEST_DATA) / "formats" / "e57" / name;
}

/// What libE57Format reads of a scan.
struct ExpectedScan {
  std::size_t points = 0;
  std::vector<double> pose;  // translation x y z, rotation w x y z; empty: none
  std::map<std::string, std::vector<double>> fields;

  bool has(const std::string& name) const { return fields.count(name) > 0; }
  double at(const std::string& name, std::size_t i) const { return fields.at(name)[i]; }
  double orZero(const std::string& name, std::size_t i) const { return has(name) ? at(name, i) : 0.0; }
};

std::vector<ExpectedScan> expectedScans(const std::string& name) {
  std::ifstream file(sample(name));
  std::vector<ExpectedScan> scans;
  std::string line, word;
  while (std::getline(file, line)) {
    ExpectedScan scan;
    std::istringstream(line) >> word >> word >> word >> scan.points;
    std::getline(file, line);
    std::istringstream pose(line.substr(5));
    for (double number; pose >> number;) scan.pose.push_back(number);
    std::getline(file, line);
    std::istringstream fields(line.substr(7));
    std::vector<std::string> names;
    while (fields >> word) names.push_back(word);
    for (std::size_t i = 0; i < scan.points; ++i)
      for (const std::string& field : names) {
        file >> word;
        scan.fields[field].push_back(std::stod(word));
      }
    std::getline(file, line);
    scans.push_back(scan);
  }
  return scans;
}

Eigen::Vector3d expectedPoint(const ExpectedScan& scan, std::size_t i) {
  if (scan.orZero("cartesianInvalidState", i) != 0 || scan.orZero("sphericalInvalidState", i) != 0)
    return Eigen::Vector3d::Constant(NAN);
  if (scan.has("cartesianX")) return {scan.at("cartesianX", i), scan.at("cartesianY", i), scan.at("cartesianZ", i)};
  const double range = scan.at("sphericalRange", i), azimuth = scan.at("sphericalAzimuth", i);
  const double elevation = scan.at("sphericalElevation", i);
  return {range * std::cos(elevation) * std::cos(azimuth), range * std::cos(elevation) * std::sin(azimuth),
          range * std::sin(elevation)};
}

TEST(E57Reader, ReadsThePointsThatLibE57FormatReads) {
  for (const std::string name : {"scans", "widths", "strings"}) {
    const std::vector<ExpectedScan> expected = expectedScans(name + ".txt");
    const std::unique_ptr<ScanFile> file = openE57(sample(name + ".e57"));
    ASSERT_EQ(file->size(), expected.size());
    ASSERT_GT(file->size(), 0u);
    for (std::size_t s = 0; s < expected.size(); ++s) {
      EXPECT_EQ(file->info(s).points, expected[s].points);
      const std::unique_ptr<ScanReader> reader = file->open(s);
      const E57Axes axes = readAll(*reader);
      ASSERT_EQ(axes[0].size(), expected[s].points);
      for (std::size_t i = 0; i < axes[0].size(); ++i) {
        const Eigen::Vector3d point = expectedPoint(expected[s], i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double value = point[static_cast<Eigen::Index>(axis)];
          if (std::isnan(value))
            EXPECT_TRUE(std::isnan(axes[axis][i]));
          else
            EXPECT_NEAR(axes[axis][i], value, expected[s].has("cartesianX") ? 0.0 : 1e-14) << name << s << " " << i;
        }
      }
    }
  }
}

TEST(E57Reader, ReadsTheValuesThatLibE57FormatReads) {
  std::size_t compared = 0;
  for (const std::string name : {"scans", "widths"}) {
    const std::vector<ExpectedScan> expected = expectedScans(name + ".txt");
    const std::unique_ptr<ScanFile> file = openE57(sample(name + ".e57"));
    for (std::size_t s = 0; s < expected.size(); ++s) {
      const std::unique_ptr<ScanReader> reader = file->open(s);
      for (const std::string& value : reader->valueNames()) {
        if (value == "rgb") continue;
        std::string field = value;
        if (value == "row" || value == "column") field += "Index";
        if (value == "time") field = "timeStamp";
        if (!expected[s].has(field)) field = "nor:" + field;
        ASSERT_TRUE(expected[s].has(field)) << value;
        const std::vector<double> values = reader->values(value);
        ASSERT_EQ(values.size(), reader->size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          const bool is_invalid = (value == "time" && expected[s].orZero("isTimeStampInvalid", i) != 0) ||
                                  (value == "intensity" && expected[s].orZero("isIntensityInvalid", i) != 0);
          if (is_invalid)
            EXPECT_TRUE(std::isnan(values[i])) << value << " " << i;
          else
            EXPECT_EQ(values[i], expected[s].at(field, i)) << value << " " << i;
        }
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 4u + 2u + 3u + 64u);
}

TEST(E57Reader, AgreesWithWebE57InTheFrameOfTheMap) {
  for (const std::string name : {"scans", "widths"}) {
    std::ifstream expected(sample(name + ".xyz"));
    const std::unique_ptr<ScanFile> file = openE57(sample(name + ".e57"));
    std::size_t lines = 0;
    std::string line;
    for (std::size_t s = 0; s < file->size(); ++s) {
      const std::unique_ptr<ScanReader> reader = file->open(s);
      const E57Axes axes = readAll(*reader);
      const std::vector<std::string> names = reader->valueNames();
      std::vector<double> colours;
      if (std::find(names.begin(), names.end(), "rgb") != names.end()) colours = reader->values("rgb");
      for (std::size_t i = 0; i < axes[0].size(); ++i) {
        if (std::isnan(axes[0][i])) continue;
        ASSERT_TRUE(std::getline(expected, line));
        ++lines;
        std::istringstream words(line);
        Eigen::Vector3d point;
        words >> point[0] >> point[1] >> point[2];
        const Eigen::Vector3d ours =
            file->info(s).pose.value_or(Pose()) * Eigen::Vector3d(axes[0][i], axes[1][i], axes[2][i]);
        EXPECT_LT((ours - point).norm(), 1e-13) << name << " " << lines;
        if (colours.empty()) continue;
        const auto rgb = static_cast<int>(colours[i]);
        for (const int ours_byte : {rgb >> 16, rgb >> 8 & 255, rgb & 255}) {
          int byte = 0;
          ASSERT_TRUE(words >> byte);
          EXPECT_LE(std::abs(ours_byte - byte), s == 0 ? 0 : 1);  // colours of 16 bits: it does not round
        }
      }
    }
    EXPECT_FALSE(std::getline(expected, line));
    EXPECT_GT(lines, 10u);
  }
}

TEST(E57Reader, ReadsWhatTheFileSaysAboutItsScans) {
  EXPECT_TRUE(isE57("ASTM-E57"));
  EXPECT_FALSE(isE57("ASTM-E5"));
  const std::unique_ptr<ScanFile> file = openE57(sample("scans.e57"));
  EXPECT_EQ(file->kind(), "E57 1.0");
  EXPECT_EQ(file->coordinateSystem(), "LOCAL_CS[\"site & <yard>\"]");
  EXPECT_FALSE(file->inMapFrame());
  ASSERT_EQ(file->size(), 3u);
  EXPECT_EQ(file->info(0).name,
            "scan 0 (Halle S\xC3\xBC"
            "d)");
  EXPECT_EQ(file->info(1).name, "scan 1 ({guid of 2})");
  ASSERT_TRUE(file->info(0).time);
  EXPECT_EQ(file->info(0).time->count(), 1234567890250000000);
  EXPECT_FALSE(file->info(1).time);
  const std::vector<ExpectedScan> expected = expectedScans("scans.txt");
  for (std::size_t s = 0; s < 2; ++s) {
    const std::optional<Pose> pose = file->info(s).pose;
    ASSERT_TRUE(pose);
    EXPECT_EQ((std::vector<double>{pose->translation[0], pose->translation[1], pose->translation[2], pose->rotation.w(),
                                   pose->rotation.x(), pose->rotation.y(), pose->rotation.z()}),
              expected[s].pose);
  }
  ASSERT_TRUE(file->info(2).pose);  // other scans have a pose, so this one is in the frame of the map
  EXPECT_TRUE(file->info(2).pose->translation.isZero());
  EXPECT_TRUE(file->info(2).pose->rotation.coeffs() == Pose().rotation.coeffs());
  ASSERT_EQ(file->warnings().size(), 1u);
  EXPECT_NE(file->warnings()[0].find("1 of 3 scans have no pose (the first is scan 2)"), std::string::npos);

  const std::unique_ptr<ScanFile> one = openE57(sample("widths.e57"));
  EXPECT_EQ(one->info(0).name, "");
  EXPECT_FALSE(one->info(0).pose);
  EXPECT_TRUE(one->warnings().empty());
}

TEST(E57Reader, ReadsFromAnyPointAndAnyThreadAfterTheFileIsClosed) {
  std::unique_ptr<ScanFile> file = openE57(sample("strings.e57"));
  const E57Axes all = readAll(*file->open(0));
  const std::unique_ptr<ScanReader> reader = file->open(0);
  file.reset();
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (std::size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&, t] {
      PointBlock<3> block;
      for (std::size_t first = t; first < 610; first += 13) {
        reader->read(first, block);
        const std::size_t expected = first < 600 ? std::min<std::size_t>(512, 600 - first) : 0;
        wrong[t] += block.size != expected;
        for (std::size_t i = 0; i < block.size; ++i)
          for (std::size_t axis = 0; axis < 3; ++axis) wrong[t] += block.coordinate[axis][i] != all[axis][first + i];
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
  reader->requireWhole();
  EXPECT_EQ(reader->columns(), 0);
  EXPECT_THROW(reader->values("cartesianX"), std::out_of_range);
}

}  // namespace
}  // namespace gaussmap::test
