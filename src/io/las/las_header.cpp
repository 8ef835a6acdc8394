// SPDX-License-Identifier: BSD-3-Clause
#include "io/las/las_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/number_text.h"
#include "gaussmap/core/error.h"
#include "io/las/las_bytes.h"

namespace gaussmap::detail {
namespace {

constexpr std::string_view kSignature = "LASF";
constexpr int kNewestVersion = 4;
constexpr int kFormats = 11;
constexpr double kSmallestScale = 1e-12;
constexpr std::size_t kVlrHeader = 54;   // [bytes]
constexpr std::size_t kEvlrHeader = 60;  // [bytes]

std::string versionOf(const LasHeader& header) {
  return "LAS 1." + std::to_string(header.minor_version);
}

class LasHeaderParser {
 public:
  LasHeaderParser(const std::filesystem::path& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  LasHeader parse() {
    readVersion();
    readLayout();
    readPointCount();
    readCoordinates();
    readVlrs();
    readEvlrs();
    readCrs();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw FileError(path_, what); }
  void warn(const std::string& what) { header_.warnings.push_back(what); }

  /// Returns the number at a byte of the header. readVersion() has checked that the header is in the file.
  template <typename T>
  T at(std::size_t byte) const {
    return lasNumber<T>(bytes_.data() + byte);
  }

  std::size_t leastHeaderSize() const {
    if (header_.minor_version <= 2) return 227;
    return header_.minor_version == 3 ? 235 : 375;
  }

  void readVersion() {
    if (bytes_.empty()) fail("the file is empty");
    if (!hasLasSignature(bytes_)) fail("does not begin with LASF: is this a LAS file?");
    constexpr std::size_t kVersionEnd = 26;
    const std::string cut_off = "the file ends inside the header: it has " + std::to_string(bytes_.size()) + " bytes";
    if (bytes_.size() < kVersionEnd) fail(cut_off);
    const int major = at<std::uint8_t>(24);
    header_.minor_version = at<std::uint8_t>(25);
    if (major != 1 || header_.minor_version > kNewestVersion)
      fail("byte 24: version " + std::to_string(major) + "." + std::to_string(header_.minor_version) +
           " of LAS, but only 1.0 to 1.4 can be read");
    if (bytes_.size() < leastHeaderSize())
      fail(cut_off + ", and the header of " + versionOf(header_) + " has " + std::to_string(leastHeaderSize()));
    header_.header_size = at<std::uint16_t>(94);
    // Some programs write 1.3 with the header of 1.2. The missing number is only the place of the waveforms.
    const std::size_t least = header_.minor_version == 3 ? 227 : leastHeaderSize();
    if (header_.header_size < least)
      fail("byte 94: the size of the header is " + std::to_string(header_.header_size) + ", but " + versionOf(header_) +
           " has at least " + std::to_string(least) + " bytes");
    header_.global_encoding = at<std::uint16_t>(6);
    if (header_.header_size >= 235 && header_.minor_version >= 3) header_.waveform_offset = at<std::uint64_t>(227);
  }

  void readLayout() {
    header_.data_offset = at<std::uint32_t>(96);
    if (header_.data_offset < header_.header_size)
      fail("byte 96: the points begin at byte " + std::to_string(header_.data_offset) +
           ", inside the header, which has " + std::to_string(header_.header_size) + " bytes");
    if (header_.data_offset > bytes_.size())
      fail("byte 96: the points begin at byte " + std::to_string(header_.data_offset) + ", but the file has only " +
           std::to_string(bytes_.size()) + " bytes: it is cut off");
    const int format = at<std::uint8_t>(104);
    header_.point_format = format & 63;
    header_.compression = format >> 6;
    if (header_.point_format >= kFormats)
      fail("byte 104: point format " + std::to_string(header_.point_format) + ", but only 0 to 10 exist");
    header_.record_length = at<std::uint16_t>(105);
    const std::size_t least = lasRecordLength(header_.point_format);
    if (header_.record_length < least)
      fail("byte 105: " + std::to_string(header_.record_length) + " bytes per point, but point format " +
           std::to_string(header_.point_format) + " needs " + std::to_string(least));
  }

  void readPointCount() {
    const std::uint64_t legacy = at<std::uint32_t>(107);
    header_.points = legacy;
    if (header_.minor_version < 4) return;
    // The number of 64 bits is valid, and the one of 32 bits is a copy for old programs, or 0.
    const auto count = at<std::uint64_t>(247);
    if (count == 0 && legacy > 0) {
      warn("the header says 0 points (byte 247) and " + std::to_string(legacy) +
           " points for old programs (byte 107): the second number is used");
      return;
    }
    header_.points = count;
    if (legacy != 0 && legacy != count)
      warn("the header says " + std::to_string(count) + " points (byte 247) and " + std::to_string(legacy) +
           " points for old programs (byte 107): the first number is used");
  }

  void readCoordinates() {
    constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      header_.scale[i] = at<double>(131 + 8 * axis);
      header_.offset[i] = at<double>(155 + 8 * axis);
      header_.maximum[i] = at<double>(179 + 16 * axis);
      header_.minimum[i] = at<double>(187 + 16 * axis);
      const std::string name = kAxes[axis];
      if (!std::isfinite(header_.scale[i]) || header_.scale[i] < kSmallestScale)
        fail("byte " + std::to_string(131 + 8 * axis) + ": the scale of " + name + " is " +
             numberText(header_.scale[i]) + ", but it must be a positive number, such as 0.001");
      if (!std::isfinite(header_.offset[i]))
        fail("byte " + std::to_string(155 + 8 * axis) + ": the offset of " + name + " is " +
             numberText(header_.offset[i]) + ", but it must be finite");
    }
  }

  void readVlrs() {
    const std::uint32_t count = at<std::uint32_t>(100);
    std::size_t place = header_.header_size;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::size_t room = header_.data_offset - place;
      const std::size_t length = room < kVlrHeader ? 0 : at<std::uint16_t>(place + 20);
      if (room < kVlrHeader + length) {
        warn("the header counts " + std::to_string(count) + " variable length records, but only " + std::to_string(i) +
             " fit before the points");
        return;
      }
      const std::size_t data = place + kVlrHeader;
      header_.vlrs.push_back(
          {lasText(bytes_.substr(place + 2, 16)), at<std::uint16_t>(place + 18), bytes_.substr(data, length), data});
      place = data + length;
    }
  }

  void readEvlrs() {
    if (header_.minor_version < 4) return;
    const std::uint32_t count = at<std::uint32_t>(243);
    if (count == 0) return;
    header_.evlr_offset = at<std::uint64_t>(235);
    if (header_.evlr_offset < header_.data_offset || header_.evlr_offset > bytes_.size()) {
      warn("the extended variable length records begin at byte " + std::to_string(header_.evlr_offset) +
           ", which is not behind the header and in the file: they are ignored");
      header_.evlr_offset = 0;
      return;
    }
    std::size_t place = header_.evlr_offset;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::size_t room = bytes_.size() - place;
      const std::uint64_t length = room < kEvlrHeader ? 0 : at<std::uint64_t>(place + 20);
      if (room < kEvlrHeader || length > room - kEvlrHeader) {
        warn("the header counts " + std::to_string(count) + " extended variable length records, but only " +
             std::to_string(i) + " fit into the file");
        return;
      }
      const std::size_t data = place + kEvlrHeader;
      header_.evlrs.push_back(
          {lasText(bytes_.substr(place + 2, 16)), at<std::uint16_t>(place + 18), bytes_.substr(data, length), data});
      place = data + length;
    }
  }

  void readCrs() {
    constexpr std::string_view kUser = "LASF_Projection";
    constexpr std::uint16_t kWkt = 2112, kGeoKeys = 34735, kGeoNames = 34737;
    const LasVlr* const wkt = header_.find(kUser, kWkt);
    const LasVlr* const keys = header_.find(kUser, kGeoKeys);
    const LasVlr* const names = header_.find(kUser, kGeoNames);
    const LasVlr* const old_wkt = header_.find("liblas", kWkt);  // written by libLAS beside the GeoTIFF keys
    if (wkt != nullptr) header_.crs = crsOfWkt(wkt->data);
    if (header_.crs.text.empty() && keys != nullptr)
      header_.crs = crsOfGeoKeys(keys->data, names != nullptr ? names->data : std::string_view());
    if (header_.crs.text.empty() && old_wkt != nullptr) header_.crs = crsOfWkt(old_wkt->data);
    warnOfUnits();
  }

  void warnOfUnits() {
    const double horizontal = header_.crs.horizontal_unit, vertical = header_.crs.vertical_unit;
    const bool is_other = std::abs(horizontal - 1.0) > 1e-3 || std::abs(vertical - 1.0) > 1e-3;
    if (header_.crs.is_geographic || !is_other) return;
    std::string what = "the coordinates are in units of " + numberText(horizontal) + " m";
    if (std::abs(vertical - horizontal) > 1e-3) what += ", z in units of " + numberText(vertical) + " m";
    warn(what +
         " by the coordinate system of the file, but lengths are taken as metres: convert "
         "the file, for example with pdal translate in.las out.las reprojection --filters.reprojection.out_srs=EPSG:N");
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  LasHeader header_;
};

}  // namespace

const LasVlr* LasHeader::find(std::string_view user_id, std::uint16_t record_id) const {
  for (const std::vector<LasVlr>* const records : {&vlrs, &evlrs})
    for (const LasVlr& record : *records)
      if (record.record_id == record_id && record.user_id == user_id) return &record;
  return nullptr;
}

bool LasHeader::hasBox() const {
  return minimum.allFinite() && maximum.allFinite() && (minimum.array() <= maximum.array()).all() &&
         !(minimum.isZero(0.0) && maximum.isZero(0.0));
}

bool hasLasSignature(std::string_view start) {
  return start.substr(0, kSignature.size()) == kSignature;
}

std::size_t lasRecordLength(int point_format) {
  constexpr std::array<std::size_t, kFormats> kLengths = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return kLengths.at(static_cast<std::size_t>(point_format));
}

LasHeader parseLasHeader(const std::filesystem::path& path, std::string_view bytes) {
  return LasHeaderParser(path, bytes).parse();
}

void checkLasPoints(const std::filesystem::path& path, std::string_view bytes, LasHeader& header) {
  const std::size_t room = (bytes.size() - header.data_offset) / header.record_length;
  if (header.points > room)
    throw FileError(path, "the header says " + std::to_string(header.points) + " points of " +
                              std::to_string(header.record_length) + " bytes from byte " +
                              std::to_string(header.data_offset) + " on, but the file holds only " +
                              std::to_string(room) + ": it is cut off, or the number is wrong");
  const std::size_t points_end = header.data_offset + header.points * header.record_length;
  std::uint64_t end = bytes.size();
  constexpr unsigned kWaveformsInside = 2;  // bit of the global encoding
  const bool has_waveforms = (header.global_encoding & kWaveformsInside) != 0;
  for (const std::uint64_t start : {has_waveforms ? header.waveform_offset : 0, header.evlr_offset}) {
    if (start < header.data_offset || start == 0) continue;
    if (start < points_end)
      throw FileError(path, "the points end at byte " + std::to_string(points_end) +
                                ", but other records begin at byte " + std::to_string(start) +
                                ": the number of points is wrong");
    end = std::min(end, start);
  }
  if (end > points_end && (end - points_end) / header.record_length > 0)
    header.warnings.push_back("the header says " + std::to_string(header.points) + " points, but there is room for " +
                              std::to_string((end - header.data_offset) / header.record_length) +
                              ": the others are not read. The program that wrote the file may not have finished it");
}

void refuseLasDegrees(const std::filesystem::path& path, const LasHeader& header) {
  if (!header.crs.is_geographic || header.points == 0) return;
  // The zone of UTM that holds the centre of the box, if the box is right.
  std::string system = "EPSG:32632";
  std::string remark = " (choose the system of your area)";
  const Eigen::Vector3d centre = 0.5 * (header.minimum + header.maximum);
  if (header.hasBox() && std::abs(centre.x()) < 180.0 && std::abs(centre.y()) < 84.0) {
    const int zone = static_cast<int>(std::floor((centre.x() + 180.0) / 6.0)) + 1;
    system = "EPSG:" + std::to_string((centre.y() < 0.0 ? 32700 : 32600) + zone);
    remark.clear();
  }
  throw FileError(path, "the coordinates are degrees, but a map needs metres: convert the file with pdal translate " +
                            path.string() + " metres.las reprojection --filters.reprojection.out_srs=" + system +
                            remark);
}

}  // namespace gaussmap::detail
