// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstring>

#include "io/laz/gps_time_decoder.h"
#include "io/laz/integer_decoder.h"
#include "io/laz/layered_items.h"
#include "io/laz/pointwise_items.h"
#include "io/laz/return_contexts.h"
#include "io/laz/running_median.h"

namespace gaussmap::detail {

namespace {

/// The record of formats 6 to 10 without its colours. The file has no padding before the time.
struct Point14 {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t returns = 0;  // return number 0 to 3, number of returns 4 to 7
  std::uint8_t flags = 0;    // classification flags 0 to 3, channel 4 and 5, scan direction 6, edge of flight line 7
  std::uint8_t classification = 0;
  std::uint8_t user_data = 0;
  std::int16_t scan_angle = 0;
  std::uint16_t source = 0;
  std::uint16_t padding = 0;
  std::uint64_t time = 0;

  unsigned returnNumber() const { return returns & 15u; }
  unsigned numberOfReturns() const { return returns >> 4; }
  unsigned channel() const { return flags >> 4 & 3u; }
  bool isFirst() const { return returnNumber() == 1; }
  bool isLast() const { return returnNumber() >= numberOfReturns(); }

  static constexpr std::size_t kBeforeTime = 22;
  void read(const char* record) {
    std::memcpy(this, record, kBeforeTime);
    std::memcpy(&time, record + kBeforeTime, sizeof time);
  }
  void write(char* record) const {
    std::memcpy(record, this, kBeforeTime);
    std::memcpy(record + kBeforeTime, &time, sizeof time);
  }
};
static_assert(offsetof(Point14, padding) == Point14::kBeforeTime, "has no padding before the time");

template <std::size_t N>
std::vector<SymbolModel> models(unsigned symbols) {
  std::vector<SymbolModel> all;
  all.reserve(N);
  for (std::size_t i = 0; i < N; ++i) all.emplace_back(symbols);
  return all;
}

// Bits of the symbol that says what changes from the last point of the channel.
constexpr unsigned kReturnChange = 3;  // 0 to 3, see nextReturns()
constexpr unsigned kReturnsChange = 1u << 2;
constexpr unsigned kAngleChange = 1u << 3;
constexpr unsigned kTimeChange = 1u << 4;
constexpr unsigned kSourceChange = 1u << 5;
constexpr unsigned kChannelChange = 1u << 6;

/// What is known of the points of one scanner channel.
class Channel {
 public:
  bool isUsed() const { return is_used_; }
  void forget() { is_used_ = false; }
  const Point14& last() const { return point_; }

  /// Starts the channel with a point before its first one.
  void start(const Point14& before) {
    is_used_ = true;
    point_ = before;
    time_changed_ = false;
    x_steps_ = {};
    y_steps_ = {};
    heights_.fill(before.z);
    intensities_.fill(before.intensity);
    times_.start(before.time);
    for (IntegerDecoder* const integers : {&dx_, &dy_, &z_, &intensity_, &scan_angle_, &source_}) integers->reset();
    for (std::vector<SymbolModel>* const all : {&changes_, &returns_, &return_, &classification_, &flags_, &user_data_})
      for (SymbolModel& model : *all) model.reset();
    channel_.reset();
    same_pulse_.reset();
  }

  /// Returns what changes in the next point, whose channel is not yet known.
  unsigned changes(ArithmeticDecoder& coder) {
    const unsigned context = (point_.isFirst() ? 1 : 0) + (point_.isLast() ? 2 : 0) + (time_changed_ ? 4 : 0);
    return coder.symbol(changes_[context]);
  }
  unsigned nextChannel(ArithmeticDecoder& coder) {
    return (point_.channel() + coder.symbol(channel_) + 1) % kScannerChannels;
  }

  /// Decodes the next point, which is in this channel.
  const Point14& next(LazLayer* layers, unsigned changes, unsigned channel) {
    point_.flags = static_cast<std::uint8_t>((point_.flags & ~0x30u) | channel << 4);
    nextReturns(layers[0].coder(), changes);
    nextCoordinates(layers, changes);
    nextAttributes(layers, changes);
    time_changed_ = (changes & kTimeChange) != 0;
    return point_;
  }
  bool failed() const { return times_.failed(); }

 private:
  void nextReturns(ArithmeticDecoder& coder, unsigned changes) {
    unsigned returns = point_.numberOfReturns();
    unsigned number = point_.returnNumber();
    if ((changes & kReturnsChange) != 0) returns = coder.symbol(returns_[returns]);
    switch (changes & kReturnChange) {
      case 1:
        number += 1;
        break;
      case 2:
        number += 15;
        break;
      case 3:
        number = (changes & kTimeChange) != 0 ? coder.symbol(return_[number]) : number + coder.symbol(same_pulse_) + 2;
        break;
      default:
        break;
    }
    point_.returns = static_cast<std::uint8_t>(returns << 4 | number % 16);
  }

  void nextCoordinates(LazLayer* layers, unsigned changes) {
    ArithmeticDecoder& coder = layers[0].coder();
    const unsigned returns = point_.numberOfReturns();
    const unsigned number = point_.returnNumber();
    const unsigned is_single = returns == 1 ? 1 : 0;
    const unsigned context = 2u * kReturnContext14[returns][number] + ((changes & kTimeChange) != 0 ? 1 : 0);
    const std::int32_t dx = dx_.decodeSigned(coder, x_steps_[context].get(), is_single);
    addWrapped(point_.x, dx);
    x_steps_[context].add(dx);

    const unsigned x_bits = std::min(dx_.lastBits(), 20u) & ~1u;
    const std::int32_t dy = dy_.decodeSigned(coder, y_steps_[context].get(), is_single + x_bits);
    addWrapped(point_.y, dy);
    y_steps_[context].add(dy);

    if (!layers[1].changes()) return;
    const unsigned xy_bits = std::min((dx_.lastBits() + dy_.lastBits()) / 2, 18u) & ~1u;
    std::int32_t& height = heights_[kReturnLevel14[returns][number]];
    height = z_.decodeSigned(layers[1].coder(), height, is_single + xy_bits);
    point_.z = height;
  }

  void nextAttributes(LazLayer* layers, unsigned changes) {
    const unsigned is_first = point_.isFirst() ? 1 : 0;
    const unsigned is_last = point_.isLast() ? 1 : 0;
    const unsigned time_changed = (changes & kTimeChange) != 0 ? 1 : 0;
    if (layers[2].changes()) {
      const unsigned context = 2 * (point_.classification & 31u) + (is_first & is_last);
      point_.classification = static_cast<std::uint8_t>(layers[2].coder().symbol(classification_[context]));
    }
    if (layers[3].changes()) nextFlags(layers[3].coder());
    if (layers[4].changes()) {
      const unsigned context = 2 * is_first + is_last;
      std::uint16_t& intensity = intensities_[2 * context + time_changed];
      intensity = static_cast<std::uint16_t>(intensity_.decode(layers[4].coder(), intensity, context));
      point_.intensity = intensity;
    }
    if (layers[5].changes() && (changes & kAngleChange) != 0)
      point_.scan_angle =
          static_cast<std::int16_t>(scan_angle_.decodeSigned(layers[5].coder(), point_.scan_angle, time_changed));
    if (layers[6].changes())
      point_.user_data = static_cast<std::uint8_t>(layers[6].coder().symbol(user_data_[point_.user_data / 4]));
    if (layers[7].changes() && (changes & kSourceChange) != 0)
      point_.source = static_cast<std::uint16_t>(source_.decode(layers[7].coder(), point_.source));
    if (layers[8].changes() && time_changed != 0) point_.time = times_.next(layers[8].coder());
  }

  /// The layer has the flags without the channel between them.
  void nextFlags(ArithmeticDecoder& coder) {
    const unsigned last = (point_.flags & 0x0Fu) | (point_.flags >> 2 & 0x30u);
    const unsigned flags = coder.symbol(flags_[last]);
    point_.flags = static_cast<std::uint8_t>((point_.flags & 0x30u) | (flags & 0x0Fu) | (flags & 0x30u) << 2);
  }

  bool is_used_ = false;
  Point14 point_;
  bool time_changed_ = false;
  std::array<RunningMedian, 12> x_steps_{}, y_steps_{};  // per return context and change of time
  std::array<std::int32_t, 8> heights_{};
  std::array<std::uint16_t, 8> intensities_{};

  std::vector<SymbolModel> changes_ = models<8>(128);
  SymbolModel channel_{kScannerChannels - 1};
  std::vector<SymbolModel> returns_ = models<16>(16), return_ = models<16>(16);
  SymbolModel same_pulse_{13};
  IntegerDecoder dx_{32, 2}, dy_{32, 22}, z_{32, 20};
  std::vector<SymbolModel> classification_ = models<64>(256), flags_ = models<64>(64), user_data_ = models<64>(256);
  IntegerDecoder intensity_{16, 4}, scan_angle_{16, 2}, source_{16};
  GpsTimeDecoder times_{false};
};

class LayeredPoint : public LayeredItem {
 public:
  std::vector<unsigned> layers() const override {
    return {kAllLazLayers, kLazZ,        kLazClassification, kLazFlags,  kLazIntensity,
            kLazScanAngle, kLazUserData, kLazPointSource,    kLazGpsTime};
  }
  void start(const char* first, unsigned channel) override {
    for (Channel& each : channels_) each.forget();
    Point14 point;
    point.read(first);
    current_ = channel;
    channels_[current_].start(point);
  }
  void decode(LazLayer* layers, PointChannel& channel, char* record) override {
    ArithmeticDecoder& coder = layers[0].coder();
    const unsigned changes = channels_[current_].changes(coder);
    channel.is_new = (changes & kChannelChange) != 0;
    if (channel.is_new) {
      const Channel& before = channels_[current_];
      current_ = channels_[current_].nextChannel(coder);
      if (!channels_[current_].isUsed()) channels_[current_].start(before.last());
    }
    channel.channel = current_;
    channels_[current_].next(layers, changes, current_).write(record);
  }
  bool failed() const override {
    return std::any_of(channels_.begin(), channels_.end(), [](const Channel& each) { return each.failed(); });
  }

 private:
  std::array<Channel, kScannerChannels> channels_;
  unsigned current_ = 0;
};

}  // namespace

std::unique_ptr<LayeredItem> layeredPoint() {
  return std::make_unique<LayeredPoint>();
}

}  // namespace gaussmap::detail
