// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/formats/scan_values.h"
#include "io/laz/laz_samples.h"

namespace gaussmap {
namespace {

class BadLazFiles : public testing::Test {
 protected:
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::filesystem::path path = directory_.write("cloud.laz", bytes);
    test::expectComplaint(test::complaintOf([&] { test::readAll(*detail::openLaz(path)); }), path, pieces);
  }
  template <typename T>
  void expectChangeRefused(std::size_t place, T value, const std::vector<std::string>& pieces) const {
    expectRefused(test::changedAt(good_, place, value), pieces);
  }
  const std::string good_ = test::lazSample("laszip_format1");
  const std::size_t record_ = 227 + 54;  // the record "laszip encoded"
  const std::size_t points_ = test::dataOffset(good_);
  const std::size_t table_ = test::tableOffset(good_);
  test::TemporaryDirectory directory_;
};

TEST_F(BadLazFiles, OtherFilesAreRefused) {
  expectRefused("", {"empty"});
  expectRefused(good_.substr(0, 100), {"header"});
  expectChangeRefused(104, std::uint8_t{1}, {"byte 104", "not compressed"});
  expectChangeRefused(104, std::uint8_t{0xC1}, {"byte 104", "outdated", "laszip -i in.laz -o out.las"});
}

TEST_F(BadLazFiles, FormatsThatAreNotSupportedAreRefused) {
  std::string bytes = test::changedAt(good_, 104, std::uint8_t{0x84});
  bytes = test::changedAt(bytes, 105, std::uint16_t{57});
  expectRefused(bytes, {"LAZ with point format 4 is not supported: convert it with 'pdal translate in.laz out.las' or "
                        "'laszip -i in.laz -o out.las'"});
  expectChangeRefused(105, std::uint16_t{28 + 1025}, {"1025 extra bytes"});
}

TEST_F(BadLazFiles, DamagedRecordsOfTheCompressionAreRefused) {
  expectChangeRefused(record_ - 54 + 2, 'L', {"'laszip encoded'", "missing"});
  expectChangeRefused(record_ - 54 + 20, std::uint16_t{33}, {"only 33 bytes"});
  expectChangeRefused(record_, std::uint16_t{3}, {"compressor 3 with coder 0", "point format 1"});
  expectChangeRefused(record_ + 2, std::uint16_t{1}, {"coder 1"});
  expectChangeRefused(record_ + 32, std::uint16_t{1}, {"1 items do not match"});
  expectChangeRefused(record_ + 32, std::uint16_t{9999}, {"no room for 9999 items"});
  expectChangeRefused(record_ + 34, std::uint16_t{10}, {"item 10 of 20 bytes", "item 6 of 20 bytes"});
  expectChangeRefused(record_ + 36, std::uint16_t{21}, {"item 6 of 21 bytes"});
  expectChangeRefused(record_ + 38, std::uint16_t{3}, {"version 3", "item 6", "convert it"});
}

TEST_F(BadLazFiles, DamagedTablesOfChunksAreRefused) {
  expectChangeRefused(points_, std::uint64_t{1} << 40, {"table of chunks is at byte 1099511627776", "cut off"});
  expectChangeRefused(points_, std::int64_t{-2}, {"not there"});
  expectChangeRefused(points_, std::uint64_t{points_}, {"not there"});
  expectChangeRefused(table_, std::uint32_t{1}, {"not there"});
  expectChangeRefused(table_ + 4, std::uint32_t{2}, {"has 2 chunks", "150 points, which need 3 chunks of 64"});
  expectChangeRefused(table_ + 4, std::uint32_t{0xFFFFFFFF}, {"4294967295 chunks", "only room for"});
  expectRefused(good_.substr(0, table_), {"not there"});
  expectRefused(good_.substr(0, table_ + 10), {"table of chunks is damaged"});
  expectRefused(good_.substr(0, table_ - 1), {"cut off"});
  expectRefused(good_.substr(0, points_ + 7), {"ends before the first point"});
}

TEST_F(BadLazFiles, WrongNumbersOfPointsAreRefused) {
  expectChangeRefused(107, std::uint32_t{0}, {"3 chunks", "0 points"});
  expectChangeRefused(107, std::uint32_t{200}, {"200 points, which need 4 chunks"});
  expectChangeRefused(107, std::uint32_t{192}, {"chunk 2", "damaged"});
  expectChangeRefused(107, std::uint32_t{140}, {"chunk 2", "its points end after"});
  expectChangeRefused(107, std::uint32_t{4000000000}, {"4000000000 points", "but the file has only"});
  const std::string variable = test::lazSample("laszip_format7_channels_variable");
  for (const std::uint64_t count : {149u, 151u}) {
    std::string bytes = test::changedAt(variable, 247, count);
    bytes = test::changedAt(bytes, 107, static_cast<std::uint32_t>(count));
    expectRefused(bytes, {count == 149 ? "chunk 3 has 2 points" : "150 points together, but the header says 151"});
  }
}

TEST_F(BadLazFiles, DamagedChunksAreRefusedWithTheirNumber) {
  // A chunk that is too short: the first of the layers is longer than the chunk.
  const std::string layered = test::lazSample("laszip_format6");
  const std::size_t chunk = test::dataOffset(layered) + 8;
  expectRefused(test::changedAt(layered, chunk + 30, std::uint32_t{63}), {"chunk 0", "63 points", "64 were expected"});
  expectRefused(test::changedAt(layered, chunk + 34, std::uint32_t{100000}), {"chunk 0", "a layer of 100000 bytes"});
  expectRefused(test::changedAt(layered, chunk + 34, std::uint32_t{0}), {"chunk 0", "no coordinates"});
  // The register of the arithmetic decoder is full of ones.
  expectRefused(test::changedAt(good_, points_ + 8 + 28, std::uint32_t{0xFFFFFFFF}), {"chunk 0 (byte", "damaged"});
}

TEST_F(BadLazFiles, UnfinishedFilesWithoutThePointsAreRefused) {
  std::string bytes = test::changedAt(good_, points_, std::int64_t{-1});
  bytes.resize(points_ + 900);
  expectRefused(bytes, {"chunk 1", "ends too early"});
  std::string variable = test::changedAt(bytes, record_ + 12, std::uint32_t{0xFFFFFFFF});
  expectRefused(variable, {"no table of chunks", "not finished"});
  std::string layered = test::lazSample("laszip_format7_channels_variable");
  layered = test::changedAt(layered, test::dataOffset(layered), std::int64_t{-1});
  layered.resize(test::dataOffset(layered) + 8);
  expectRefused(layered, {"chunk 0", "0 points"});
}

TEST_F(BadLazFiles, AnyChangeIsReadOrRefused) {
  std::vector<std::string> good;
  for (const char* const name : {"laszip_format0", "laszip_format1_pipe", "laszip_format3_extra", "laszip_format3_v1",
                                 "laszip_format6", "laszip_format8_channels", "lazperf_format7_channels_variable"})
    good.push_back(test::lazSample(name));
  test::expectMutationsReadOrRefused(
      good, [&](const std::string& bytes) { test::readAll(*detail::openLaz(directory_.write("cloud.laz", bytes))); });
}

}  // namespace
}  // namespace gaussmap
