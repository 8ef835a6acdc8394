// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/formats/scan_values.h"
#include "io/las/las_builder.h"
#include "io/las/las_file.h"

namespace gaussmap {
namespace {

using test::LasBytes;

class BadLasFiles : public testing::Test {
 protected:
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::filesystem::path path = directory_.write("cloud.las", bytes);
    test::expectComplaint(test::complaintOf([&] { test::readAll(*detail::openLas(path)); }), path, pieces);
  }
  template <typename T>
  static std::string changed(std::string bytes, std::size_t place, T value) {
    std::memcpy(&bytes[place], &value, sizeof(value));
    return bytes;
  }
  template <typename T>
  void expectChangeRefused(std::size_t place, T value, const std::vector<std::string>& pieces) const {
    expectRefused(changed(LasBytes().str(), place, value), pieces);
  }
  std::string warnings(const std::string& bytes) const {
    std::string text;
    for (const std::string& warning : detail::openLas(directory_.write("cloud.las", bytes))->warnings())
      text += warning + "\n";
    return text;
  }
  test::TemporaryDirectory directory_;
};

TEST_F(BadLasFiles, OtherKindsOfFilesAreRefused) {
  expectRefused("", {"empty"});
  expectRefused("# .PCD v0.7", {"LASF"});
  expectRefused("LASF", {"ends inside the header: it has 4 bytes"});
  expectChangeRefused(104, std::uint8_t{128}, {"compressed", "LAZ", "pdal translate"});
}

TEST_F(BadLasFiles, HeadersThatMakeNoSenseAreRefused) {
  expectChangeRefused(24, std::uint8_t{2}, {"byte 24", "version 2.2", "1.0 to 1.4"});
  expectChangeRefused(25, std::uint8_t{5}, {"version 1.5"});
  expectChangeRefused(25, std::uint8_t{4}, {"header of LAS 1.4 has 375"});
  expectRefused(changed(LasBytes().str() + std::string(200, '\0'), 25, std::uint8_t{4}), {"byte 94", "227", "375"});
  expectChangeRefused(94, std::uint16_t{226}, {"byte 94", "226"});
  expectChangeRefused(96, std::uint32_t{226}, {"byte 96", "inside the header"});
  expectChangeRefused(96, std::uint32_t{1000}, {"byte 96", "byte 1000", "only 267 bytes"});
  expectChangeRefused(104, std::uint8_t{11}, {"byte 104", "point format 11"});
  expectChangeRefused(104, std::uint8_t{1}, {"byte 105", "20 bytes per point", "needs 28"});
  expectChangeRefused(105, std::uint16_t{0}, {"byte 105", "0 bytes per point"});
  expectChangeRefused(139, 0.0, {"byte 139", "scale of y is 0"});
  expectChangeRefused(139, -0.001, {"byte 139", "must be a positive number"});
  expectChangeRefused(131, 1e-300, {"byte 131", "scale of x is 1e-300"});
  expectChangeRefused(147, std::nan(""), {"byte 147", "scale of z"});
  expectChangeRefused(155, std::numeric_limits<double>::infinity(), {"byte 155", "offset of x is inf"});
}

TEST_F(BadLasFiles, PointsThatAreMissingAreRefusedWithBothNumbers) {
  const std::string good = LasBytes().str();
  for (const std::uint32_t count : {3u, 1000u, 4294967295u})
    expectChangeRefused(107, count, {"header says " + std::to_string(count) + " points of 20 bytes", "holds only 2"});
  expectRefused(good.substr(0, good.size() - 1), {"2 points", "only 1", "cut off"});
  for (std::size_t size = 0; size < good.size(); ++size) expectRefused(good.substr(0, size), {});
  LasBytes bytes;
  bytes.minor = 4;
  for (const std::uint64_t count : {std::uint64_t{3}, std::uint64_t{1} << 60, ~std::uint64_t{0}}) {
    bytes.count = count;
    expectRefused(bytes.str(), {"header says " + std::to_string(count), "holds only 2"});
  }
}

TEST_F(BadLasFiles, RecordsInsideThePointsAreRefused) {
  LasBytes bytes;
  bytes.minor = 4;
  bytes.evlrs = test::evlr("somebody", 1, "xyz");
  bytes.evlr_count = 1;
  bytes.count = 3;
  expectRefused(bytes.str(), {"the points end at byte 435", "records begin at byte 415"});
}

TEST_F(BadLasFiles, ACountOfRecordsThatIsWrongIsAWarning) {
  LasBytes bytes;
  bytes.vlrs = test::vlr("somebody", 1, "xyz");
  bytes.vlr_count = 4000000000u;
  EXPECT_NE(warnings(bytes.str()).find("4000000000 variable length records, but only 1 fit"), std::string::npos);
  bytes.minor = 4;
  bytes.evlrs = test::evlr("somebody", 1, "xyz");
  bytes.vlr_count = 1;
  bytes.evlr_count = 2;
  EXPECT_NE(warnings(bytes.str()).find("2 extended variable length records, but only 1 fit"), std::string::npos);
  bytes.evlr_count = 1;
  EXPECT_EQ(warnings(bytes.str()), "");
  EXPECT_NE(warnings(changed(bytes.str(), 235, std::uint64_t{10})).find("byte 10"), std::string::npos);
  EXPECT_NE(warnings(changed(bytes.str(), 235, ~std::uint64_t{0})).find("they are ignored"), std::string::npos);
  std::string long_record = bytes.str();
  std::memset(&long_record[bytes.dataOffset() + 40 + 20], 0xFF, 8);
  EXPECT_NE(warnings(long_record).find("only 0 fit"), std::string::npos);
}

TEST_F(BadLasFiles, DegreesAreRefusedWithTheCommandThatConvertsThem) {
  LasBytes bytes;
  bytes.box = {-83.4, -83.6, 39.1, 39.0, 200, 100};
  bytes.vlrs = test::vlr("LASF_Projection", 34735, test::geoKeys({{1024, 0, 1, 2}, {2048, 0, 1, 4326}}));
  bytes.vlr_count = 1;
  expectRefused(bytes.str(), {"degrees", "pdal translate", "reprojection --filters.reprojection.out_srs=EPSG:32617"});
  bytes.vlrs = test::vlr("LASF_Projection", 2112, "GEOGCS[\"WGS 84\",UNIT[\"degree\",0.01745]]");
  bytes.box = {18.2, 18.1, -33.8, -34.0, 200, 100};
  expectRefused(bytes.str(), {"degrees", "EPSG:32734"});
  bytes.box = {};
  expectRefused(bytes.str(), {"degrees", "choose the system of your area"});
  bytes.points.clear();
  bytes.count = 0;
  EXPECT_EQ(warnings(bytes.str()), "");
}

TEST_F(BadLasFiles, DamagedFilesAreReadOrRefused) {
  std::vector<std::string> good;
  for (const int format : {0, 3, 10}) {
    LasBytes bytes;
    bytes.minor = format == 10 ? 4 : 2;
    bytes.format = format;
    bytes.record_length = format == 0 ? 24 : format == 3 ? 34 : 67;
    const std::string extra = test::padded(std::string("\0\0\x9\x1height", 10), 192);
    bytes.vlrs = test::vlr("LASF_Projection", 2112, "PROJCS[\"a\",GEOGCS[\"b\"],UNIT[\"metre\",1]]") +
                 test::vlr("LASF_Spec", 4, extra);
    bytes.vlr_count = 2;
    bytes.evlr_count = bytes.minor == 4 ? 1 : 0;
    if (bytes.minor == 4)
      bytes.evlrs = test::evlr("LASF_Projection", 34735, test::geoKeys({{1024, 0, 1, 1}, {3072, 0, 1, 32632}}));
    good.push_back(bytes.str());
  }
  Random random(3);
  for (int round = 0; round < 6000; ++round) {
    const std::string bytes = test::mutated(good[random.below(good.size())], random);
    test::complaintOf([&] { test::readAll(*detail::openLas(directory_.write("cloud.las", bytes))); });
  }
}

}  // namespace
}  // namespace gaussmap
