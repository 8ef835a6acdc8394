// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "io/laz/byte_after_byte.h"
#include "io/laz/integer_decoder.h"
#include "io/laz/pointwise_items.h"

namespace gaussmap::detail {

namespace {

/// Predicts a step by the median of the last three.
class StepsV1 {
 public:
  std::int32_t median() const {
    const auto [a, b, c] = last_;
    return std::max(std::min(a, b), std::min(std::max(a, b), c));
  }
  void add(std::int32_t step) {
    last_[next_] = step;
    next_ = (next_ + 1) % last_.size();
  }

 private:
  std::array<std::int32_t, 3> last_{};
  std::size_t next_ = 0;
};

class Point10V1 : public PointwiseItem {
 public:
  void start(const char* first) override {
    std::memcpy(&point_, first, sizeof point_);
    x_steps_ = {};
    y_steps_ = {};
    for (IntegerDecoder* const integers : {&dx_, &dy_, &z_, &intensity_, &scan_angle_, &source_}) integers->reset();
    for (ByteAfterByte* const bytes : {&flags_, &classification_, &user_data_}) bytes->reset();
    changes_.reset();
  }

  void decode(ArithmeticDecoder& coder, char* record) override {
    const std::int32_t dx = dx_.decodeSigned(coder, x_steps_.median());
    addWrapped(point_.x, dx);
    x_steps_.add(dx);
    const std::int32_t dy = dy_.decodeSigned(coder, y_steps_.median(), std::min(dx_.lastBits(), 19u));
    addWrapped(point_.y, dy);
    y_steps_.add(dy);
    const unsigned bits = (dx_.lastBits() + dy_.lastBits()) / 2;
    point_.z = z_.decodeSigned(coder, point_.z, std::min(bits, 19u));

    const unsigned changes = coder.symbol(changes_);
    if ((changes & 32) != 0) point_.intensity = static_cast<std::uint16_t>(intensity_.decode(coder, point_.intensity));
    if ((changes & 16) != 0) flags_.next(coder, point_.flags);
    if ((changes & 8) != 0) classification_.next(coder, point_.classification);
    if ((changes & 4) != 0)
      point_.scan_angle = static_cast<std::uint8_t>(scan_angle_.decode(coder, point_.scan_angle, bits < 3 ? 1 : 0));
    if ((changes & 2) != 0) user_data_.next(coder, point_.user_data);
    if ((changes & 1) != 0) point_.source = static_cast<std::uint16_t>(source_.decode(coder, point_.source));
    std::memcpy(record, &point_, sizeof point_);
  }

 private:
  Point10 point_;
  StepsV1 x_steps_, y_steps_;
  IntegerDecoder dx_{32}, dy_{32, 20}, z_{32, 20};
  IntegerDecoder intensity_{16}, scan_angle_{8, 2}, source_{16};
  ByteAfterByte flags_, classification_, user_data_;
  SymbolModel changes_{64};
};

/// Like GpsTimeDecoder, with one sequence.
class GpsTime11V1 : public PointwiseItem {
 public:
  void start(const char* first) override {
    std::memcpy(&time_, first, sizeof time_);
    step_ = 0;
    extremes_ = 0;
    multiples_.reset();
    first_steps_.reset();
    integers_.reset();
  }

  void decode(ArithmeticDecoder& coder, char* record) override {
    if (step_ == 0)
      decodeWithoutStep(coder);
    else
      decodeAfterStep(coder);
    std::memcpy(record, &time_, sizeof time_);
  }

 private:
  static constexpr unsigned kMaxMultiple = 509, kFar = 510;  // the symbol 511 repeats the time

  void decodeWithoutStep(ArithmeticDecoder& coder) {
    const unsigned symbol = coder.symbol(first_steps_);  // 0 repeats the time
    if (symbol == 2) return decodeWhole(coder);
    if (symbol == 0) return;
    step_ = integers_.decodeSigned(coder, 0, 0);
    add(step_);
  }

  void decodeAfterStep(ArithmeticDecoder& coder) {
    const unsigned symbol = coder.symbol(multiples_);
    if (symbol == kFar) return decodeWhole(coder);
    if (symbol > kFar) return;
    if (symbol == 1) {
      step_ = integers_.decodeSigned(coder, step_, 1);
      extremes_ = 0;
      return add(step_);
    }
    const unsigned context = symbol == 0 ? 2 : symbol < 10 ? 3 : symbol < 50 ? 4 : 5;
    const std::uint32_t predicted =
        symbol == 0 ? static_cast<std::uint32_t>(step_ / 4) : symbol * static_cast<std::uint32_t>(step_);
    const auto step = static_cast<std::int32_t>(integers_.decode(coder, predicted, context));
    add(step);
    if ((symbol == 0 || symbol == kMaxMultiple) && ++extremes_ > 3) {
      step_ = step;
      extremes_ = 0;
    }
  }

  void decodeWhole(ArithmeticDecoder& coder) {
    time_ = 0;
    for (unsigned shift = 0; shift < 64; shift += 16) time_ |= static_cast<std::uint64_t>(coder.bits(16)) << shift;
  }
  void add(std::int32_t step) { time_ += static_cast<std::uint64_t>(static_cast<std::int64_t>(step)); }

  std::uint64_t time_ = 0;
  std::int32_t step_ = 0;
  int extremes_ = 0;
  SymbolModel multiples_{512};
  SymbolModel first_steps_{3};
  IntegerDecoder integers_{32, 6};
};

class BytesV1 : public PointwiseItem {
 public:
  explicit BytesV1(std::size_t size) : bytes_(size), integers_(8, static_cast<unsigned>(size)) {}
  void start(const char* first) override {
    std::memcpy(bytes_.data(), first, bytes_.size());
    integers_.reset();
  }
  void decode(ArithmeticDecoder& coder, char* record) override {
    for (unsigned i = 0; i < bytes_.size(); ++i) next(coder, i);
    std::memcpy(record, bytes_.data(), bytes_.size());
  }

 protected:
  void next(ArithmeticDecoder& coder, unsigned i) {
    bytes_[i] = static_cast<std::uint8_t>(integers_.decode(coder, bytes_[i], i));
  }
  std::vector<std::uint8_t> bytes_;

 private:
  IntegerDecoder integers_;
};

/// The bytes of a colour, with a symbol that says which of them have changed.
class Rgb12V1 : public BytesV1 {
 public:
  Rgb12V1() : BytesV1(6) {}
  void start(const char* first) override {
    BytesV1::start(first);
    changes_.reset();
  }
  void decode(ArithmeticDecoder& coder, char* record) override {
    const unsigned changes = coder.symbol(changes_);
    for (unsigned i = 0; i < 6; ++i)
      if ((changes >> i & 1) != 0) next(coder, i);
    std::memcpy(record, bytes_.data(), bytes_.size());
  }

 private:
  SymbolModel changes_{64};
};

}  // namespace

std::unique_ptr<PointwiseItem> pointwiseItemV1(const LazItem& item) {
  switch (item.type) {
    case LazItemType::Point10:
      return std::make_unique<Point10V1>();
    case LazItemType::GpsTime11:
      return std::make_unique<GpsTime11V1>();
    case LazItemType::Rgb12:
      return std::make_unique<Rgb12V1>();
    default:
      return std::make_unique<BytesV1>(item.size);
  }
}

}  // namespace gaussmap::detail
