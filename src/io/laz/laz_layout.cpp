// SPDX-License-Identifier: BSD-3-Clause
#include "io/laz/laz_layout.h"

#include <utility>

#include "gaussmap/core/error.h"
#include "io/las/las_bytes.h"

namespace gaussmap::detail {

namespace {

constexpr std::uint32_t kVariable = 0xFFFFFFFFu;  // as the number of points per chunk

std::string conversionHint() {
  return "convert it with 'pdal translate in.laz out.las' or 'laszip -i in.laz -o out.las'";
}

/// Returns the items of the points of a format, with version 0; empty if the format is not supported.
std::vector<LazItem> itemsOf(const LasHeader& header) {
  using Type = LazItemType;
  std::vector<LazItem> items;
  const int format = header.point_format;
  if (format <= 3) {
    items = {{Type::Point10, 20, 0}};
    if (format == 1 || format == 3) items.push_back({Type::GpsTime11, 8, 0});
    if (format >= 2) items.push_back({Type::Rgb12, 6, 0});
  } else if (format >= 6 && format <= 8) {
    items = {{Type::Point14, 30, 0}};
    if (format == 7) items.push_back({Type::Rgb14, 6, 0});
    if (format == 8) items.push_back({Type::RgbNir14, 8, 0});
  }
  const std::size_t extra = header.record_length - lasRecordLength(format);
  if (!items.empty() && extra > 0)
    items.push_back({format <= 3 ? Type::Bytes : Type::Bytes14, static_cast<std::uint16_t>(extra), 0});
  return items;
}

class LazLayoutParser {
 public:
  LazLayoutParser(const std::filesystem::path& path, const LasHeader& header) : path_(path), header_(header) {}

  LazLayout parse() {
    if (header_.compression != 2)
      fail(header_.compression == 0
               ? "byte 104: the points are not compressed: this is a LAS file"
               : "byte 104: an outdated compression of LAZ, which is not supported: " + conversionHint());
    const std::vector<LazItem> expected = itemsOf(header_);
    if (expected.empty())
      fail("LAZ with point format " + std::to_string(header_.point_format) + " is not supported: " + conversionHint());
    constexpr std::size_t kMaxExtraBytes = 1024;  // each needs 5 kB for its statistics
    if (expected.back().size > kMaxExtraBytes)
      fail("LAZ with " + std::to_string(expected.back().size) + " extra bytes per point is not supported (limit: " +
           std::to_string(kMaxExtraBytes) + "): " + conversionHint());
    record_ = header_.find("laszip encoded", 22204);
    constexpr std::size_t kFixedPart = 34, kItem = 6;  // [bytes]
    if (record_ == nullptr) fail("the record 'laszip encoded', which says how the points are compressed, is missing");
    if (record_->data.size() < kFixedPart) damaged(0, "it has only " + std::to_string(record_->data.size()) + " bytes");
    readCompressor();
    const std::size_t count = at<std::uint16_t>(32);
    if (record_->data.size() < kFixedPart + kItem * count)
      damaged(32, "it has no room for " + std::to_string(count) + " items");
    if (count != expected.size()) damaged(32, std::to_string(count) + " items do not match the point format");
    for (std::size_t i = 0; i < count; ++i) readItem(kFixedPart + kItem * i, expected[i]);
    return std::move(layout_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw FileError(path_, what); }
  [[noreturn]] void damaged(std::size_t place, const std::string& what) const {
    fail("byte " + std::to_string(record_->offset + place) + ": the record 'laszip encoded' is damaged: " + what);
  }
  template <typename T>
  T at(std::size_t place) const {
    return lasNumber<T>(record_->data.data() + place);
  }

  void readCompressor() {
    enum : unsigned { kOneChunk = 1, kChunks = 2, kLayeredChunks = 3 };
    const unsigned compressor = at<std::uint16_t>(0);
    const unsigned coder = at<std::uint16_t>(2);
    layout_.is_layered = header_.point_format >= 6;
    const bool is_known =
        layout_.is_layered ? compressor == kLayeredChunks : compressor == kOneChunk || compressor == kChunks;
    if (!is_known || coder != 0)
      damaged(0, "compressor " + std::to_string(compressor) + " with coder " + std::to_string(coder) +
                     " does not exist for point format " + std::to_string(header_.point_format));
    layout_.has_chunks = compressor != kOneChunk;
    const auto chunk_points = at<std::uint32_t>(12);
    layout_.chunk_points = chunk_points == kVariable ? 0 : chunk_points;
  }

  void readItem(std::size_t place, LazItem expected) {
    const auto type = at<std::uint16_t>(place);
    const auto size = at<std::uint16_t>(place + 2);
    if (type != static_cast<std::uint16_t>(expected.type) || size != expected.size)
      damaged(place, "item " + std::to_string(type) + " of " + std::to_string(size) +
                         " bytes does not match the point format, which has item " +
                         std::to_string(static_cast<unsigned>(expected.type)) + " of " + std::to_string(expected.size) +
                         " bytes here");
    expected.version = at<std::uint16_t>(place + 4);
    const unsigned newest = layout_.is_layered ? 4 : 2;
    if (expected.version > newest || expected.version + 1u < newest)
      fail("byte " + std::to_string(record_->offset + place + 4) + ": version " + std::to_string(expected.version) +
           " of the compression of item " + std::to_string(type) + " is not supported: " + conversionHint());
    layout_.items.push_back(expected);
  }

  const std::filesystem::path& path_;
  const LasHeader& header_;
  const LasVlr* record_ = nullptr;
  LazLayout layout_;
};

}  // namespace

LazLayout parseLazLayout(const std::filesystem::path& path, const LasHeader& header) {
  return LazLayoutParser(path, header).parse();
}

}  // namespace gaussmap::detail
