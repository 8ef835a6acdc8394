// SPDX-License-Identifier: BSD-3-Clause
// Damaged and hostile E57 files.
#include <gtest/gtest.h>

#include "io/e57/e57_bytes.h"
#include "io/e57/e57_file.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"

namespace gaussmap::test {
using namespace detail;

namespace {

class BadE57 : public testing::Test {
 protected:
  /// Reads everything of a file. Returns the message of the FileError, or "".
  std::string complaint(const std::string& bytes) const {
    const std::filesystem::path path = directory_.write("bad.e57", bytes);
    return complaintOf([&] {
      const std::unique_ptr<ScanFile> file = openE57(path);
      file->warnings();
      for (std::size_t i = 0; i < file->size(); ++i) {
        file->info(i);
        const std::unique_ptr<ScanReader> reader = file->open(i);
        EXPECT_EQ(readAll(*reader)[0].size(), reader->size());
        for (const std::string& name : reader->valueNames()) EXPECT_EQ(reader->values(name).size(), reader->size());
      }
    });
  }
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::string text = complaint(bytes);
    expectComplaint(text, directory_.path() / "bad.e57", pieces);
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
  /// Expects that a file with one single point and this XML section is refused.
  void expectXmlRefused(const std::string& xml, const std::vector<std::string>& pieces) const {
    const std::string value = e57Bytes(1.0f);
    expectRefused(e57File(e57Section(dataPacket({value, value, value})), xml), pieces);
  }
  /// Like above, with bytes replaced in a good XML section.
  void expectRefusedWith(const std::string& from, const std::string& to, const std::vector<std::string>& pieces) const {
    std::string xml = e57Xml(e57ScanXml(1, kSingleXyz));
    const std::size_t place = xml.find(from);
    ASSERT_NE(place, std::string::npos) << from;
    expectXmlRefused(xml.replace(place, from.size(), to), pieces);
  }
  void expectSectionRefused(const std::string& section, const std::vector<std::string>& pieces,
                            std::uint64_t points = 1) const {
    expectRefused(e57File(section, e57Xml(e57ScanXml(points, kSingleXyz))), pieces);
  }

  TemporaryDirectory directory_;
};

template <typename T>
std::string with(std::string bytes, std::size_t place, T value) {
  return bytes.replace(place, sizeof(T), e57Bytes(value));
}

TEST_F(BadE57, HeadersAreChecked) {
  const std::string good = singleFile(300, 300);
  EXPECT_EQ(complaint(good), "");
  expectRefused("", {"is not an E57 file"});
  expectRefused("ASTM-E58" + good.substr(8), {"is not an E57 file"});
  expectRefused(good.substr(0, 47), {"has 47 bytes", "48"});
  expectRefused(with(good, 8, 2u), {"version 2.0", "only version 1"});
  for (const std::uint64_t page : {0u, 4u, 1023u, 1u << 21})
    expectRefused(with(good, 40, page), {"byte 40", "the pages have " + std::to_string(page), "1024"});
  expectRefused(with(good, 40, ~std::uint64_t{0}), {"byte 40"});
  expectRefused(with(good, 16, std::uint64_t{0}), {"byte 16"});
  expectRefused(with(good, 16, std::uint64_t{1025}), {"byte 16", "not a multiple of the page size 1024"});
  expectRefused(with(good, 16, ~std::uint64_t{0}), {"18446744073709551615", "cut off"});
  expectRefused(with(good, 24, std::uint64_t{1} << 40), {"the XML section is at byte 1099511627776"});
  expectRefused(with(good, 24, std::uint64_t{1022}), {"inside the checksum"});
  expectRefused(with(good, 32, ~std::uint64_t{0}), {"the XML section", "18446744073709551615 bytes"});
}

TEST_F(BadE57, WrongChecksumsNameThePage) {
  const std::string good = singleFile(300, 300);
  ASSERT_GE(good.size(), 5 * 1024u);
  for (std::size_t page = 0; page < good.size() / 1024; ++page)
    for (const std::size_t place : {700u, 1023u}) {
      std::string bad = good;
      bad[page * 1024 + place] = static_cast<char>(bad[page * 1024 + place] ^ 16);
      expectRefused(bad, {"page " + std::to_string(page) + " (bytes " + std::to_string(page * 1024) + " to " +
                              std::to_string(page * 1024 + 1023) + ")",
                          "checksum", "damaged"});
    }
}

TEST_F(BadE57, TruncatedFilesAreRefused) {
  const std::string good = singleFile(300, 300);
  for (std::size_t length = 0; length < good.size(); length += 97) EXPECT_NE(complaint(good.substr(0, length)), "");
  expectRefused(good.substr(0, 2048), {"has 2048 bytes, but its header gives " + std::to_string(good.size())});
}

TEST_F(BadE57, XmlIsChecked) {
  expectXmlRefused("", {"XML section is damaged"});
  expectXmlRefused("<e57Root>", {"XML section is damaged"});
  expectXmlRefused(std::string(100, '\0'), {"XML section"});
  expectXmlRefused("<root/>", {"no element e57Root"});
  expectXmlRefused(e57Xml("<vectorChild/>"), {"scan 0: has no element points"});
  expectRefusedWith("CompressedVector", "Structure", {"type 'Structure', expected CompressedVector"});
  expectRefusedWith("fileOffset", "offset", {"no attribute fileOffset"});
  expectRefusedWith("recordCount=\"1\"", "recordCount=\"-1\"", {"recordCount of the points is '-1'", "whole number"});
  expectRefusedWith("prototype", "prototypes", {"XML section is damaged"});
  expectRefusedWith("<cartesianX", "<cartesianY", {"two fields 'cartesianY'"});
  expectRefusedWith("<cartesianX", "<cartesianQ", {"neither cartesianX, cartesianY and cartesianZ nor"});
  expectRefusedWith("single", "half", {"precision of field 'cartesianX' is 'half'"});
  expectRefusedWith("Float", "Structure", {"field 'cartesianX' has the type 'Structure'"});
  expectRefusedWith("<codecs type=\"Vector\"/>", "<codecs><vectorChild><zipCodec/></vectorChild></codecs>",
                    {"codec 'zipCodec' is unknown"});
  expectXmlRefused(e57Xml(e57ScanXml(1, kSingleXyz + e57Integer("intensity", 3, 2))),
                   {"minimum of field 'intensity' is 3, greater than its maximum 2"});
  expectXmlRefused(e57Xml(e57ScanXml(1, kSingleXyz + "<i type=\"Integer\" minimum=\"1.5\"/>")),
                   {"'1.5', not an integer"});
  expectXmlRefused(e57Xml(e57ScanXml(1, kSingleXyz + "<i type=\"ScaledInteger\" scale=\"nan\"/>")),
                   {"scale of field 'i'"});
  expectXmlRefused(e57Xml(e57ScanXml(1, kSingleXyz, "<pose><rotation><w>1</w></rotation></pose>")),
                   {"the pose/rotation has no element x"});
  expectXmlRefused(e57Xml(e57ScanXml(1, kSingleXyz, "<pose><translation><x>a\nb</x></translation></pose>")),
                   {"pose/translation/x is 'a\\x0ab', not a number"});
}

TEST_F(BadE57, HostileXmlIsHarmless) {
  // Entities are not expanded.
  std::string bomb = "<!DOCTYPE x [<!ENTITY a0 \"aaaaaaaaaa\">";
  for (int i = 1; i < 20; ++i)
    bomb += "<!ENTITY a" + std::to_string(i) + " \"&a" + std::to_string(i - 1) + ";&a" + std::to_string(i - 1) + ";\">";
  const std::string value = e57Bytes(1.0f), section = e57Section(dataPacket({value, value, value}));
  const std::string scan = e57ScanXml(1, kSingleXyz, "<name>&a19;</name>");
  const auto path = directory_.write("bad.e57", e57File(section, bomb + "]>" + e57Xml(scan + e57ScanXml(0, ""))));
  EXPECT_EQ(openE57(path)->info(0).name, "scan 0 (&a19;)");

  // Deep nesting, before and inside the scans.
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  EXPECT_NE(complaint(e57File(section, deep)), "");
  for (int i = 0; i < 200000; ++i) deep += "</a>";
  EXPECT_EQ(complaint(e57File(section, e57Xml(e57ScanXml(1, kSingleXyz, deep), deep))), "");

  // Names stay on one line.
  const auto named = directory_.write(
      "bad.e57", e57File(section, e57Xml(e57ScanXml(1, kSingleXyz,
                                                    "<name> a\n\x1B[1m\xC2\x9B" + std::string(200, 'b') + "</name>") +
                                         e57ScanXml(0, ""))));
  EXPECT_EQ(openE57(named)->info(0).name, "scan 0 (a  [1m " + std::string(73, 'b') + "...)");
}

TEST_F(BadE57, SectionsMustLieInTheFile) {
  const auto offset = [](std::uint64_t place) { return "fileOffset=\"" + std::to_string(place) + "\""; };
  const std::string good = offset(48);
  expectRefusedWith(good, offset(std::uint64_t{1} << 50),
                    {"scan 0: the section of the points is at byte 1125899906842624"});
  expectRefusedWith(good, offset(1020), {"byte 1020", "inside the checksum"});
  expectRefusedWith(good, offset(1000), {"byte 1000 and has 32 bytes, but only 20 bytes follow"});
  expectRefusedWith(good, offset(0), {"starts with 65, expected 1"});

  const std::string value = e57Bytes(1.0f), section = e57Section(dataPacket({value, value, value}));
  expectSectionRefused(with(section, 8, ~std::uint64_t{0}), {"18446744073709551615 bytes, but only"});
  expectSectionRefused(with(section, 8, std::uint64_t{31}), {"the first packet", "has 31 bytes"});
  expectSectionRefused(with(section, 8, std::uint64_t{40}), {"takes at least 12 bytes", "has 8"});
  for (const std::uint64_t place : {0u, 79u, 110u, 1023u, 1u << 30})
    expectSectionRefused(with(section, 16, place),
                         {"the first packet of the points is at byte " + std::to_string(place)});
}

TEST_F(BadE57, RecordCountsMustAgreeWithThePackets) {
  expectRefused(singleFile(300, 400), {"recordCount is 400, which takes at least 4800 bytes"});
  expectRefused(singleFile(300, 301),
                {"recordCount is 301, but the packets hold only 300 points of the field cartesianX"});
  expectRefused(singleFile(300, 298), {"more of the field cartesianX than recordCount = 298 allows"});
  for (const std::uint64_t points : {std::uint64_t{1} << 58, std::uint64_t{1} << 63, ~std::uint64_t{0}})
    expectRefused(singleFile(300, points), {"recordCount is " + std::to_string(points)});
  const std::string constant =
      e57Integer("cartesianX", 1, 1) + e57Integer("cartesianY", 2, 2) + e57Integer("cartesianZ", 3, 3);
  const std::string section = e57Section(dataPacket({"", "", ""}));
  for (const std::uint64_t points : {std::uint64_t{100000}, ~std::uint64_t{0}})
    expectRefused(e57File(section, e57Xml(e57ScanXml(points, constant))), {"all fields are constant"});
  std::string scans;
  for (int i = 0; i < 3; ++i) scans += e57ScanXml(900, constant);
  expectRefused(e57File(section, e57Xml(scans)), {"scan 2", "all fields are constant"});
}

TEST_F(BadE57, ScansCannotShareTheirSection) {
  std::string scans, fields[3];
  for (int i = 0; i < 30; ++i) scans += e57ScanXml(300, kSingleXyz);
  for (std::string& field : fields) field = std::string(1200, '\0');
  expectRefused(e57File(e57Section(dataPacket({fields[0], fields[1], fields[2]})), e57Xml(scans)), {"share sections"});
}

TEST_F(BadE57, PacketsAreChecked) {
  const std::string value = e57Bytes(1.0f), packet = dataPacket({value, value, value});
  const std::string place = "scan 0: the packet at byte 80 ";
  expectSectionRefused(e57Section(with(packet, 0, '\3')), {place + "has the type 3"});
  expectSectionRefused(e57Section(with(packet, 2, std::uint16_t{24})), {place + "has the length 25"});
  expectSectionRefused(e57Section(with(packet, 2, std::uint16_t{65535})), {place + "has the length 65536"});
  expectSectionRefused(e57Section(with(packet, 2, std::uint16_t{3})), {place + "has 4 bytes, too few"});
  expectSectionRefused(e57Section(with(packet, 2, std::uint16_t{7})),
                       {place + "is too short for the lengths of its 3"});
  expectSectionRefused(e57Section(with(packet, 4, std::uint16_t{2})), {place + "holds 2 fields", "describes 3"});
  expectSectionRefused(e57Section(with(packet, 8, std::uint16_t{60000})),
                       {place + "has 24 bytes, but its fields have more"});
  expectSectionRefused(e57Section(dataPacket({value, value, ""}) + std::string(2, '\0')),
                       {"the packet at byte 100 has only 2 bytes"});
  expectSectionRefused(e57Section(packet + packet), {"the packet at byte 104 holds more of the field cartesianX"});
}

TEST_F(BadE57, IntegersMustNotExceedTheirMaximum) {
  const std::string fields =
      e57Integer("cartesianX", 0, 5) + e57Integer("cartesianY", 0, 0) + e57Integer("cartesianZ", 0, 0);
  const std::string packet = dataPacket({packBits({5, 0, 6, 7}, 3), "", ""});
  expectRefused(e57File(e57Section(packet), e57Xml(e57ScanXml(4, fields))),
                {"scan 0: point 2: the field cartesianX is greater than its maximum 5"});
}

TEST_F(BadE57, MutationsAreReadOrRefused) {
  // The checksums are made after the mutation, so that the damage reaches the parsers.
  const std::string value = e57Bytes(1.0f), byte(1, '\1');
  const std::string body = e57Section(dataPacket({value, value, value, byte, byte, byte, byte}));
  const std::string xml = e57Xml(e57ScanXml(
      1,
      kSingleXyz + e57Integer("colorRed", 0, 255) + e57Integer("colorGreen", 0, 255) + e57Integer("colorBlue", 0, 255) +
          e57Integer("cartesianInvalidState", 0, 2),
      "<pose><rotation><w>1</w><x/><y/><z/></rotation><translation><x>1</x><y>2</y><z>3</z></translation></pose>"));
  std::size_t round = 0;
  expectMutationsReadOrRefused({body, xml}, [&](const std::string& bytes) {
    const bool is_xml = bytes.find("<prototype") != std::string::npos || bytes.size() > body.size() + 20;
    const std::string text = complaint(is_xml ? e57File(body, bytes) : e57File(bytes, xml));
    ++round;
    if (!text.empty()) throw FileError("bad.e57", text);
  });
  EXPECT_GT(round, 1000u);
}

}  // namespace
}  // namespace gaussmap::test
