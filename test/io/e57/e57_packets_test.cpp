// SPDX-License-Identifier: BSD-3-Clause
// Packets, encodings and values that need files written byte by byte.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/e57/crc32c.h"
#include "io/e57/e57_bytes.h"
#include "io/e57/e57_file.h"
#include "io/files/temporary_directory.h"

namespace gaussmap::test {
using namespace detail;

namespace {

const std::string kConstantXyz = e57Integer("cartesianX", 1, 1) + e57Integer("cartesianY", 2, 2) +
                                 "<cartesianZ type=\"ScaledInteger\" minimum=\"6\" maximum=\"6\" scale=\"0.5\"/>";

class E57Packets : public testing::Test {
 protected:
  std::unique_ptr<ScanFile> open(const std::string& bytes) const { return openE57(directory_.write("a.e57", bytes)); }
  /// Opens a file with one scan of constant coordinates and these fields.
  std::unique_ptr<ScanFile> openFields(std::uint64_t points, const std::string& xml, std::vector<std::string> fields,
                                       const std::string& more = "") const {
    fields.insert(fields.begin(), 3, "");
    return open(e57File(e57Section(dataPacket(fields)), e57Xml(e57ScanXml(points, kConstantXyz + xml, more))));
  }

  TemporaryDirectory directory_;
};

TEST(Crc32c, EqualsTheOneFromBits) {
  EXPECT_EQ(crc32c("123456789"), 0xE3069283u);
  EXPECT_EQ(crc32c(std::string(32, '\0')), 0x8A9136AAu);  // RFC 3720
  EXPECT_EQ(crc32c(std::string(32, '\xFF')), 0x62A8AB43u);
  std::string bytes;
  for (unsigned i = 0; i < 40; ++i) {
    EXPECT_EQ(crc32c(bytes), slowCrc32c(bytes));
    bytes += static_cast<char>(i * 77);
  }
}

TEST_F(E57Packets, CanBeOfAnyLengthAndFieldsCanBeCutAnywhere) {
  constexpr std::size_t kPoints = 700;
  std::vector<std::uint64_t> x, y, z;
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    x.push_back(i * 11 % 8000);
    y.push_back(i % 2);
    z.push_back(i * 0x9E3779B97F4A7C15u % 0x100000000000000u);
  }
  const std::string xml = e57Integer("cartesianX", -4000, 4191) + e57Integer("cartesianY", 5, 6) +
                          e57Integer("cartesianZ", 0, 0xFFFFFFFFFFFFFF);
  for (const std::size_t piece : {1u, 3u, 64u, 5000u}) {
    const std::string packets = dataPackets({packBits(x, 13), packBits(y, 1), packBits(z, 56)}, piece);
    const auto file = open(e57File(e57Section(packets), e57Xml(e57ScanXml(kPoints, xml))));
    const E57Axes axes = readAll(*file->open(0));
    ASSERT_EQ(axes[0].size(), kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      EXPECT_EQ(axes[0][i], static_cast<double>(x[i]) - 4000);
      EXPECT_EQ(axes[1][i], static_cast<double>(y[i]) + 5);
      EXPECT_EQ(axes[2][i], static_cast<double>(z[i]));
    }
  }
}

TEST_F(E57Packets, IndexAndEmptyPacketsAreSkipped) {
  const std::string value = e57Bytes(1.5f);
  const std::string index = std::string("\0\0", 2) + e57Bytes(std::uint16_t{31}) + std::string(28, '\7');
  const std::string empty = std::string("\2\0", 2) + e57Bytes(std::uint16_t{3});
  const std::string first = dataPacket({value, value, ""}), second = dataPacket({"", "", value});
  for (const std::string& packets : {index + first + empty + empty + second + index, first + second,
                                     first + index + second + std::string(2, '\5'),  // too short for a packet
                                     first + second + std::string(16, '\xFF')}) {    // no packet
    const auto file = open(e57File(e57Section(packets), e57Xml(e57ScanXml(1, kSingleXyz))));
    EXPECT_EQ(readAll(*file->open(0)), (E57Axes{{1.5}, {1.5}, {1.5}}));
  }
}

TEST_F(E57Packets, IntegersCanBeFilledUpToAWord) {
  const auto file = openFields(1, e57Integer("a", 0, 3), {"\2" + std::string(7, '\xFF')});
  EXPECT_EQ(file->open(0)->values("a"), std::vector<double>{2});
  EXPECT_THROW(openFields(1, e57Integer("a", 0, 3), {std::string(9, '\2')})->open(0)->values("a"), FileError);
}

TEST_F(E57Packets, ConstantFieldsTakeNoBits) {
  const auto file = openFields(3, "", {});
  EXPECT_EQ(readAll(*file->open(0)), (E57Axes{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}}));
}

TEST_F(E57Packets, IntegersCanHaveTheRangeOf64Bits) {
  const std::int64_t least = std::numeric_limits<std::int64_t>::min(), most = std::numeric_limits<std::int64_t>::max();
  const std::string words = e57Bytes(std::uint64_t{0}) + e57Bytes(~std::uint64_t{0}) + e57Bytes(std::uint64_t{1} << 63);
  const auto file = openFields(3, "<a type=\"Integer\"/>" + e57Integer("b", least, most - 1), {words, words});
  EXPECT_EQ(file->open(0)->values("a"), (std::vector<double>{-0x1p63, 0x1p63, 0.0}));
  EXPECT_THROW(file->open(0)->values("b"), FileError);
}

TEST_F(E57Packets, PagesCanHaveOtherSizes) {
  for (const std::size_t page : {64u, 512u, 4096u, 1u << 20}) {
    const auto file = open(singleFile(300, 300, page));
    const E57Axes axes = readAll(*file->open(0));
    ASSERT_EQ(axes[2].size(), 300u);
    for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(axes[2][i], static_cast<double>(i) + 0.5);
  }
}

TEST_F(E57Packets, BytesAfterTheLastPageAreIgnoredWithAWarning) {
  const auto file = open(singleFile(2, 2) + "more");
  EXPECT_EQ(file->warnings(), std::vector<std::string>{"4 bytes after the last page are ignored"});
  EXPECT_EQ(readAll(*file->open(0))[0], (std::vector<double>{0, 1}));
}

TEST_F(E57Packets, ScansWithoutPointsNeedNoSection) {
  const auto file = open(e57File("", e57Xml(e57ScanXml(0, "", "", 1 << 30) + e57ScanXml(0, kSingleXyz))));
  EXPECT_EQ(file->size(), 2u);
  for (std::size_t s = 0; s < 2; ++s) EXPECT_EQ(readAll(*file->open(s)), E57Axes(3));
  EXPECT_EQ(file->open(1)->valueNames(), std::vector<std::string>());
  const auto none = open(e57File("", "<e57Root/>"));
  EXPECT_EQ(none->size(), 0u);
  EXPECT_EQ(none->warnings(), std::vector<std::string>{"the file has no scans, only 0 images"});
}

TEST_F(E57Packets, CartesianCoordinatesComeBeforeSphericalOnes) {
  const std::string spherical =
      "<sphericalRange type=\"Float\" precision=\"single\"/><sphericalAzimuth type=\"Float\" precision=\"single\"/>"
      "<sphericalElevation type=\"Float\" precision=\"single\"/>";
  const std::string value = e57Bytes(4.0f);
  const auto both = openFields(1, spherical, {value, value, value});
  EXPECT_EQ(readAll(*both->open(0)), (E57Axes{{1}, {2}, {3}}));
  EXPECT_EQ(both->open(0)->values("sphericalRange"), std::vector<double>{4.0});
}

TEST_F(E57Packets, ColoursAreScaledToBytes) {
  const std::string three(e57Bytes(std::uint16_t{0}) + e57Bytes(std::uint16_t{32896}) + e57Bytes(std::uint16_t{65535}));
  const auto names = [](const std::string& rest) {
    return "<colorRed " + rest + "/><colorGreen " + rest + "/><colorBlue " + rest + "/>";
  };
  const auto limits = [](const std::string& largest) {
    std::string xml = "<colorLimits type=\"Structure\">";
    for (const std::string colour : {"Red", "Green", "Blue"})
      xml += "<color" + colour + "Minimum type=\"Float\"/><color" + colour + "Maximum type=\"Float\">" + largest +
             "</color" + colour + "Maximum>";
    return xml + "</colorLimits>";
  };
  const std::string integers = names("type=\"Integer\" minimum=\"0\" maximum=\"65535\"");
  const std::vector<double> grey = {0, 128 * 0x10101, 255 * 0x10101};
  EXPECT_EQ(openFields(3, integers, {three, three, three})->open(0)->values("rgb"), grey);
  EXPECT_EQ(openFields(3, integers, {three, three, three}, limits("65535"))->open(0)->values("rgb"), grey);
  // With limits of 8 bits, greater numbers are cut.
  EXPECT_EQ(openFields(3, integers, {three, three, three}, limits("255"))->open(0)->values("rgb"),
            (std::vector<double>{0, 255 * 0x10101, 255 * 0x10101}));

  const std::string reals = e57Bytes(0.0) + e57Bytes(0.5) + e57Bytes(std::nan(""));
  EXPECT_EQ(openFields(3, names("type=\"Float\""), {reals, reals, reals}, limits("1"))->open(0)->values("rgb"),
            (std::vector<double>{0, 128 * 0x10101, 0}));
  const auto unknown =
      openFields(2, names("type=\"Float\""), {reals.substr(0, 16), reals.substr(0, 16), reals.substr(0, 16)});
  EXPECT_EQ(unknown->open(0)->valueNames(), (std::vector<std::string>{"colorRed", "colorGreen", "colorBlue"}));
  EXPECT_EQ(unknown->open(0)->values("colorRed"), (std::vector<double>{0, 0.5}));
}

TEST_F(E57Packets, ExtensionsCannotTakeTheNamesOfTheStandard) {
  const std::string byte(1, '\5'), seven(1, '\7');
  const auto file =
      openFields(1,
                 e57Integer("ext:intensity", 0, 255) + e57Integer("intensity", 0, 255) + e57Integer("ext:row", 0, 255) +
                     e57Integer("other:row", 0, 255) + e57Integer("ext:isColorInvalid", 0, 255),
                 {byte, seven, byte, seven, byte});
  const auto reader = file->open(0);
  EXPECT_EQ(reader->valueNames(),
            (std::vector<std::string>{"intensity", "ext:intensity", "row", "other:row", "isColorInvalid"}));
  EXPECT_EQ(reader->values("intensity"), std::vector<double>{7});
  EXPECT_EQ(reader->values("ext:intensity"), std::vector<double>{5});
  EXPECT_EQ(reader->values("other:row"), std::vector<double>{7});
}

}  // namespace
}  // namespace gaussmap::test
