// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/scans/file_scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "io/files/natural_order.h"
#include "io/files/temporary_directory.h"
#include "io/scans/scan_names.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::TemporaryDirectory;

std::vector<std::string> namesOf(const std::vector<std::filesystem::path>& scans) {
  std::vector<std::string> names;
  for (const std::filesystem::path& scan : scans) names.push_back(scan.filename().string());
  return names;
}

/// Returns the resident memory of mapped files [bytes].
std::size_t mappedBytes() {
  std::ifstream status("/proc/self/status");
  std::size_t kilobytes = 0;
  for (std::string word; status >> word;)
    if (word == "RssFile:") status >> kilobytes;
  return kilobytes << 10;
}

TEST(FileScansOfManyFiles, ReleaseTheMemoryOfFilesThatWereRead) {
  constexpr std::size_t kFiles = 40, kPoints = 100000;
  const std::vector<float> records(4 * kPoints, 0.5f);
  const std::string bytes(reinterpret_cast<const char*>(records.data()), records.size() * sizeof(float));
  const TemporaryDirectory directory;
  std::vector<FileScan> list;
  for (std::size_t i = 0; i < kFiles; ++i) list.push_back({directory.write(std::to_string(i) + ".bin", bytes), Pose()});
  const std::size_t before = mappedBytes();
  const FileScans scans(list);
  PointBlock<3> block;
  for (int round = 0; round < 2; ++round)
    for (std::size_t i = 0; i < kFiles; ++i) {
      const std::unique_ptr<ScanReader> reader = scans.open(i);
      std::size_t count = 0;
      for (reader->read(0, block); block.size > 0; reader->read(count, block)) {
        EXPECT_EQ(block.coordinate[2][0], 0.5);
        count += block.size;
      }
      EXPECT_EQ(count, kPoints);
    }
  EXPECT_LT(mappedBytes(), before + 15 * bytes.size());
}

TEST(ScanList, SortsTheScansOfADirectoryAsPeopleCount) {
  const TemporaryDirectory directory;
  for (const char* const name : {"scan10.pcd", "scan2.PCD", "scan1.pcd", "notes.txt", ".hidden.pcd", "scan02b.pcd"})
    directory.write(name, "");
  std::filesystem::create_directory(directory.path() / "folder.pcd");
  std::filesystem::create_directory(directory.path() / "deeper");
  directory.write("deeper/scan3.pcd", "");
  EXPECT_EQ(namesOf(listScans({directory.path()})),
            (std::vector<std::string>{"scan1.pcd", "scan2.PCD", "scan02b.pcd", "scan10.pcd"}));
}

TEST(ScanList, TakesFilesOfOneKindFromADirectoryAndPcdFilesFirst) {
  const TemporaryDirectory directory;
  for (const char* const name : {"b.LAS", "a.las", "poses.txt", "list.csv"}) directory.write(name, "");
  EXPECT_EQ(namesOf(listScans({directory.path()})), (std::vector<std::string>{"a.las", "b.LAS"}));
  directory.write("c.laz", "");
  try {
    listScans({directory.path()});
    ADD_FAILURE() << "files of two kinds";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("holds files of several kinds: .las (2 files), .laz (1 file)"),
              std::string::npos)
        << error.what();
  }
  directory.write("d.pcd", "");
  EXPECT_EQ(namesOf(listScans({directory.path()})), std::vector<std::string>{"d.pcd"});
}

TEST(ScanList, KeepsTheOrderOfTheInputs) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory.path() / "a");
  directory.write("a/1.pcd", "");
  directory.write("a/2.pcd", "");
  const std::filesystem::path last = directory.write("any.name", "");
  EXPECT_EQ(namesOf(listScans({last, directory.path() / "a", last})),
            (std::vector<std::string>{"any.name", "1.pcd", "2.pcd", "any.name"}));
  EXPECT_TRUE(listScans({}).empty());
}

TEST(ScanList, RefusesWhatIsNotThere) {
  const TemporaryDirectory directory;
  EXPECT_THROW(listScans({directory.path() / "none.pcd"}), FileError);
  EXPECT_THROW(listScans({directory.path()}), FileError);
}

TEST(NaturalLess, IsAnOrderOfAllNames) {
  const std::vector<std::string> sorted = {"",      "01",     "1",      "1a",  "2",  "10",  "99999999999999999999999",
                                           "a",     "a-1",    "a0",     "a01", "a1", "a1b", "a2",
                                           "a2b10", "a2b011", "a2b100", "a10", "b"};
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = 0; j < sorted.size(); ++j)
      EXPECT_EQ(naturalLess(sorted[i], sorted[j]), i < j) << sorted[i] << " and " << sorted[j];
}

}  // namespace
}  // namespace gaussmap
