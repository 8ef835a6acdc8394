// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "io/laz/byte_after_byte.h"
#include "io/laz/colour_decoder.h"
#include "io/laz/gps_time_decoder.h"
#include "io/laz/integer_decoder.h"
#include "io/laz/pointwise_items.h"
#include "io/laz/return_contexts.h"
#include "io/laz/running_median.h"

namespace gaussmap::detail {

namespace {

class Point10V2 : public PointwiseItem {
 public:
  void start(const char* first) override {
    std::memcpy(&point_, first, sizeof point_);
    x_steps_ = {};
    y_steps_ = {};
    intensities_ = {};
    heights_ = {};
    changes_.reset();
    flags_.reset();
    intensity_.reset();
    classification_.reset();
    for (SymbolModel& model : scan_angle_) model.reset();
    user_data_.reset();
    source_.reset();
    dx_.reset();
    dy_.reset();
    z_.reset();
  }

  void decode(ArithmeticDecoder& coder, char* record) override {
    const unsigned changes = coder.symbol(changes_);
    if ((changes & 32) != 0) flags_.next(coder, point_.flags);
    const unsigned context = kReturnContext[point_.returns()][point_.returnNumber()];
    if (changes != 0) decodeAttributes(coder, changes, context);
    point_.intensity = intensities_[context];
    decodeCoordinates(coder, context);
    std::memcpy(record, &point_, sizeof point_);
  }

 private:
  void decodeAttributes(ArithmeticDecoder& coder, unsigned changes, unsigned context) {
    if ((changes & 16) != 0)
      intensities_[context] =
          static_cast<std::uint16_t>(intensity_.decode(coder, intensities_[context], std::min(context, 3u)));
    if ((changes & 8) != 0) classification_.next(coder, point_.classification);
    if ((changes & 4) != 0)
      point_.scan_angle =
          static_cast<std::uint8_t>(point_.scan_angle + coder.symbol(scan_angle_[point_.scanDirection()]));
    if ((changes & 2) != 0) user_data_.next(coder, point_.user_data);
    if ((changes & 1) != 0) point_.source = static_cast<std::uint16_t>(source_.decode(coder, point_.source));
  }

  void decodeCoordinates(ArithmeticDecoder& coder, unsigned context) {
    const unsigned is_single = point_.returns() == 1 ? 1 : 0;
    const std::int32_t dx = dx_.decodeSigned(coder, x_steps_[context].get(), is_single);
    addWrapped(point_.x, dx);
    x_steps_[context].add(dx);

    const unsigned x_bits = std::min(dx_.lastBits(), 20u) & ~1u;
    const std::int32_t dy = dy_.decodeSigned(coder, y_steps_[context].get(), is_single + x_bits);
    addWrapped(point_.y, dy);
    y_steps_[context].add(dy);

    const unsigned xy_bits = std::min((dx_.lastBits() + dy_.lastBits()) / 2, 18u) & ~1u;
    std::int32_t& height = heights_[kReturnLevel[point_.returns()][point_.returnNumber()]];
    height = z_.decodeSigned(coder, height, is_single + xy_bits);
    point_.z = height;
  }

  Point10 point_;
  std::array<RunningMedian, 16> x_steps_{}, y_steps_{};  // per return context
  std::array<std::uint16_t, 16> intensities_{};
  std::array<std::int32_t, 8> heights_{};

  SymbolModel changes_{64};
  ByteAfterByte flags_, classification_, user_data_;
  IntegerDecoder intensity_{16, 4};
  std::array<SymbolModel, 2> scan_angle_{SymbolModel(256), SymbolModel(256)};
  IntegerDecoder source_{16};
  IntegerDecoder dx_{32, 2};
  IntegerDecoder dy_{32, 22};
  IntegerDecoder z_{32, 20};
};

class GpsTime11V2 : public PointwiseItem {
 public:
  void start(const char* first) override {
    std::uint64_t time = 0;
    std::memcpy(&time, first, sizeof time);
    times_.start(time);
  }
  void decode(ArithmeticDecoder& coder, char* record) override {
    const std::uint64_t time = times_.next(coder);
    std::memcpy(record, &time, sizeof time);
  }
  bool failed() const override { return times_.failed(); }

 private:
  GpsTimeDecoder times_{true};
};

class Rgb12V2 : public PointwiseItem {
 public:
  void start(const char* first) override {
    std::memcpy(colour_.data(), first, sizeof colour_);
    colours_.reset();
  }
  void decode(ArithmeticDecoder& coder, char* record) override {
    colours_.next(coder, colour_);
    std::memcpy(record, colour_.data(), sizeof colour_);
  }

 private:
  ColourDecoder::Colour colour_{};
  ColourDecoder colours_;
};

class BytesV2 : public PointwiseItem {
 public:
  explicit BytesV2(std::size_t size) : bytes_(size) {
    models_.reserve(size);
    for (std::size_t i = 0; i < size; ++i) models_.emplace_back(256);
  }
  void start(const char* first) override {
    std::memcpy(bytes_.data(), first, bytes_.size());
    for (SymbolModel& model : models_) model.reset();
  }
  void decode(ArithmeticDecoder& coder, char* record) override {
    for (std::size_t i = 0; i < bytes_.size(); ++i)
      bytes_[i] = static_cast<std::uint8_t>(bytes_[i] + coder.symbol(models_[i]));
    std::memcpy(record, bytes_.data(), bytes_.size());
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::vector<SymbolModel> models_;
};

}  // namespace

std::unique_ptr<PointwiseItem> pointwiseItemV2(const LazItem& item) {
  switch (item.type) {
    case LazItemType::Point10:
      return std::make_unique<Point10V2>();
    case LazItemType::GpsTime11:
      return std::make_unique<GpsTime11V2>();
    case LazItemType::Rgb12:
      return std::make_unique<Rgb12V2>();
    default:
      return std::make_unique<BytesV2>(item.size);
  }
}

}  // namespace gaussmap::detail
