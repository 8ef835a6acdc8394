// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/logs/carmen_log.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaussmap/core/gaussian.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/logs/gzip.h"

namespace gaussmap {
namespace {

using test::complaintOf;
using test::expectComplaint;
using test::gzipped;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

/// FLASER with n ranges of 2.5 m at (1, 2, 0.5).
std::string flaser(int n, const std::string& range = "2.5") {
  std::string line = "FLASER " + std::to_string(n);
  for (int i = 0; i < n; ++i) line += " " + range;
  return line + " 1 2 0.5 0 0 0 976052857.3 host 0.1\n";
}

class CarmenLogTest : public testing::Test {
 protected:
  CarmenLog read(const std::string& bytes) const { return readCarmenLog(directory_.write("a.log", bytes)); }
  std::string complaint(const std::string& bytes) const {
    return complaintOf([&] { read(bytes); });
  }
  std::filesystem::path path() const { return directory_.path() / "a.log"; }

  test::TemporaryDirectory directory_;
};

TEST_F(CarmenLogTest, ReadsRangesAndThePoseOfTheLaser) {
  const CarmenLog log = read(
      "# a comment\nPARAM robot_width 0.5\nODOM 0 0 0 0 0 0 0.1 host 0.1\n"
      "FLASER 3 1.5 2.25 81.83 -4 5.5 0.25 0 0 0 976052857.3 host 0.1\n");
  EXPECT_TRUE(log.faults.empty());
  ASSERT_EQ(log.scans.size(), 1u);
  const LaserScan& scan = log.scans[0];
  EXPECT_EQ(scan.ranges, (std::vector<double>{1.5, 2.25, 81.83}));
  EXPECT_EQ(scan.pose.translation, Vector<2>(-4, 5.5));
  EXPECT_EQ(scan.pose.heading, 0.25);
  EXPECT_TRUE(scan.pose.covariance.isZero(0.0));
  EXPECT_TRUE(scan.returned(1));
  EXPECT_FALSE(scan.returned(2));  // what a SICK writes for no return
}

TEST_F(CarmenLogTest, KnowsTheBearingsOfASickByTheNumberOfItsBeams) {
  const struct {
    int beams;
    double first, step;  // degrees
  } cases[] = {{180, -90, 1.0},  {181, -90, 1.0},  {360, -90, 0.5}, {361, -90, 0.5},
               {400, -50, 0.25}, {401, -50, 0.25}, {91, -90, 2.0},  {1, -90, 0.0}};
  for (const auto& one : cases) {
    const LaserScan scan = read(flaser(one.beams)).scans.at(0);
    ASSERT_EQ(scan.bearings.size(), static_cast<std::size_t>(one.beams));
    for (int i = 0; i < one.beams; ++i)
      ASSERT_NEAR(scan.bearings[static_cast<std::size_t>(i)] / kDegree, one.first + i * one.step, 1e-9) << one.beams;
  }
}

TEST_F(CarmenLogTest, TakesTheFanOfRobotLaserFromItsLine) {
  const std::string before = "ROBOTLASER1 0 -1.0 2.0 0.5 30.0 0.01 0 ",
                    after = " 7 8 0.75 7 8 0.75 0 0 0 0 0 1.0 host 1.0\n";
  const LaserScan scan = read(before + "5 1 2 3 29.9 30.1 2 100 200" + after).scans.at(0);
  EXPECT_EQ(scan.bearings, (std::vector<double>{-1.0, -0.5, 0.0, 0.5, 1.0}));
  EXPECT_EQ(scan.pose.translation, Vector<2>(7, 8));
  EXPECT_EQ(scan.pose.heading, 0.75);
  EXPECT_TRUE(scan.returned(3));
  EXPECT_FALSE(scan.returned(4));
  EXPECT_EQ(read(before + "2 1 2 0" + after).scans.at(0).pose.translation, Vector<2>(7, 8));
  // Without a step it follows from the field of view; above 80 m a SICK says no return.
  const LaserScan sick = read("ROBOTLASER1 0 -1.0 2.0 0 81.92 0.01 0 3 1 2 81.83 0" + after).scans.at(0);
  EXPECT_EQ(sick.bearings, (std::vector<double>{-1.0, 0.0, 1.0}));
  EXPECT_FALSE(sick.returned(2));
  EXPECT_TRUE(read("ROBOTLASER1 0 -1.0 2.0 0 120 0.01 0 2 1 119 0" + after).scans.at(0).returned(1));
}

TEST_F(CarmenLogTest, KeepsBeamsWithoutReturnInTheirPlace) {
  const LaserScan scan = read("FLASER 6 0 inf nan -1 3 -inf 0 0 0\n").scans.at(0);
  ASSERT_EQ(scan.ranges.size(), 6u);
  for (std::size_t beam = 0; beam < 6; ++beam) EXPECT_EQ(scan.returned(beam), beam == 4) << beam;
}

TEST_F(CarmenLogTest, NamesDamagedLinesAndReadsTheOthers) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"FLASER", "ends before the number of ranges"},
      {"FLASER 3 1 2", "is 3, but only 2 words follow"},
      {"FLASER 99999999999999999999 1 2", "expected the number of ranges"},
      {"FLASER -3 1 2 3 0 0 0", "'-3'"},
      {"FLASER 2.5 1 2 3 0 0 0", "'2.5'"},
      {"FLASER 0 0 0 0", "no beams"},
      {"FLASER 2 1 2x 0 0 0", "expected the range, found '2x'"},
      {"FLASER 2 1 2 0 0", "ends before the heading"},
      {"FLASER 2 1 2 nan 0 0", "x of the pose is not finite"},
      {"FLASER 2 1 2 0 0 inf", "heading of the pose is not finite"},
      {"FLASER 2 1 2 0 2e9 0", "more than 10^9 m"},
      {"FLASER 2 1 2 3 4 5 6 7 8 9 10 11 12", "words after the 2 ranges"},
      {"ROBOTLASER1 0 -1 2 0.5 30 0.01 0 2 1 2 9 1 2 3 4", "number of remissions is 9"},
      {"ROBOTLASER1 0 -1 2 -0.5 30 0.01 0 2 1 2 0 1 2 3 4", "step must be above 0"},
      {"ROBOTLASER1 0 -1 2 7 30 0.01 0 3 1 2 3 0 1 2 3 4", "at most a full turn"},
      {"ROBOTLASER1 0 -1 2 0.5 0 0.01 0 2 1 2 0 1 2 3 4", "maximum range"},
      {"ROBOTLASER1 0 1e6 2 0.5 30 0.01 0 2 1 2 0 1 2 3 4", "start angle"}};
  std::string all = flaser(180);
  for (const auto& [line, reason] : bad) all += line + "\r\n" + flaser(181);
  const CarmenLog log = read(all);
  EXPECT_EQ(log.scans.size(), bad.size() + 1);
  ASSERT_EQ(log.faults.size(), bad.size());
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_EQ(log.faults[i].line, 2 * i + 2);
    EXPECT_NE(log.faults[i].what.find(bad[i].second), std::string::npos) << bad[i].first << ": " << log.faults[i].what;
  }
}

TEST_F(CarmenLogTest, RefusesALogWithoutAScan) {
  expectComplaint(complaint(""), path(), {"no usable scan"});
  expectComplaint(complaint("ODOM 0 0 0 0 0 0 0.1 host 0.1\n"), path(), {"no usable scan", "FLASER"});
  expectComplaint(complaint("\nFLASER 2 1\n"), path(), {"no usable scan", "line 2: ", "only 1 words follow"});
  expectComplaint(complaint(std::string(100000, '\0')), path(), {"no usable scan"});
  expectComplaint(complaint(gzipped("")), path(), {"no usable scan"});
  expectComplaint(complaintOf([&] { readCarmenLog(directory_.path()); }), directory_.path(), {});
  expectComplaint(complaintOf([&] { readCarmenLog(directory_.path() / "no.log"); }), directory_.path() / "no.log", {});
}

TEST_F(CarmenLogTest, CountsFaultsBeyondTheFirstThousand) {
  std::string text = flaser(5);
  for (int i = 0; i < 1234; ++i) text += "FLASER\n";
  const CarmenLog log = read(text);
  EXPECT_EQ(log.faults.size(), 1000u);
  EXPECT_EQ(log.more_faults, 234u);
}

/// A log of lines that do not repeat, so that gzip has something to do.
std::string longLog(int scans) {
  std::string text;
  Random random(7);
  for (int s = 0; s < scans; ++s) {
    text += "FLASER 180";
    for (int i = 0; i < 180; ++i) text += " " + std::to_string(random.uniform() * 20.0);
    text += " " + std::to_string(s) + " 2 0.5 0 0 0 1 host 1\n";
  }
  return text;
}

void expectFirstScansOf(const CarmenLog& part, const CarmenLog& whole) {
  ASSERT_LE(part.scans.size(), whole.scans.size());
  for (std::size_t i = 0; i < part.scans.size(); ++i) {
    ASSERT_EQ(part.scans[i].ranges, whole.scans[i].ranges) << i;
    ASSERT_EQ(part.scans[i].pose.translation, whole.scans[i].pose.translation) << i;
  }
}

TEST_F(CarmenLogTest, ReadsGzipLikeText) {
  const std::string text = longLog(200), half = text.substr(0, text.size() / 2);
  const CarmenLog plain = read(text), packed = read(gzipped(text));
  EXPECT_EQ(plain.scans.size(), 200u);
  EXPECT_EQ(packed.scans.size(), 200u);
  expectFirstScansOf(packed, plain);
  EXPECT_TRUE(packed.faults.empty());
  // Joined files, and zeros behind as tape drives leave them.
  const CarmenLog joined = read(gzipped(half) + gzipped(text.substr(half.size())) + std::string(512, '\0'));
  EXPECT_EQ(joined.scans.size(), 200u);
  EXPECT_TRUE(joined.faults.empty());
}

TEST_F(CarmenLogTest, KeepsWhatComesBeforeTheDamageOfAGzip) {
  const std::string text = longLog(200), packed = gzipped(text);
  const CarmenLog whole = read(text);
  const CarmenLog half = read(packed.substr(0, packed.size() / 2));
  expectFirstScansOf(half, whole);
  EXPECT_NEAR(static_cast<double>(half.scans.size()), 100.0, 3.0);
  ASSERT_EQ(half.faults.size(), 1u);
  EXPECT_EQ(half.faults[0].line, half.scans.size() + 1);
  EXPECT_NE(half.faults[0].what.find("cut off"), std::string::npos) << half.faults[0].what;

  const CarmenLog no_checksum = read(packed.substr(0, packed.size() - 4));
  EXPECT_EQ(no_checksum.scans.size(), 200u);
  EXPECT_EQ(no_checksum.faults.size(), 1u);

  std::string wrong = packed;
  wrong[packed.size() - 6] = static_cast<char>(wrong[packed.size() - 6] ^ 1);  // of the checksum
  const CarmenLog checked = read(wrong);
  EXPECT_EQ(checked.scans.size(), 200u);
  ASSERT_EQ(checked.faults.size(), 1u);
  EXPECT_NE(checked.faults[0].what.find("damaged at byte"), std::string::npos) << checked.faults[0].what;

  const CarmenLog more = read(packed + "more");
  EXPECT_EQ(more.scans.size(), 200u);
  ASSERT_EQ(more.faults.size(), 1u);
  EXPECT_NE(more.faults[0].what.find("4 bytes after"), std::string::npos) << more.faults[0].what;
}

TEST_F(CarmenLogTest, TakesNoMemoryForALineWithoutEnd) {
  const std::string text = flaser(10) + std::string(std::size_t{40} << 20, 'F');  // 40 MB, 40 kB packed
  const CarmenLog log = read(gzipped(text));
  EXPECT_EQ(log.scans.size(), 1u);
}

TEST_F(CarmenLogTest, ReadsOrRefusesWhateverTheBytesAre) {
  const std::string text = flaser(4) + "ROBOTLASER1 0 -1 2 0.5 30 0.01 0 2 1 2 1 3 1 2 3 4 5 6 7 8 9 10 11 host 12\n";
  test::expectMutationsReadOrRefused({"FLASER 2 1 2 0 0 0\n", gzipped(text)}, [&](const std::string& bytes) {
    const CarmenLog log = read(bytes);
    for (const LaserScan& scan : log.scans) {
      ASSERT_FALSE(scan.ranges.empty());
      ASSERT_EQ(scan.ranges.size(), scan.bearings.size());
      ASSERT_TRUE(scan.pose.translation.allFinite() && std::isfinite(scan.pose.heading));
    }
  });
}

TEST(CarmenLogName, EndsInLogOrClfPlainOrGzip) {
  for (const char* const name : {"a.log", "b/A.LOG", "a.log.gz", "a.clf", "a.clf.gz", "a.b.log.GZ"})
    EXPECT_TRUE(isCarmenLogName(name)) << name;
  for (const char* const name : {"a.pcd", "log", "a.gz", "a.log.pcd", "a.pcd.gz", "", ".gz"})
    EXPECT_FALSE(isCarmenLogName(name)) << name;
}

}  // namespace
}  // namespace gaussmap
