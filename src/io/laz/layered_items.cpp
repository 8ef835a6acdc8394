// SPDX-License-Identifier: BSD-3-Clause
#include "io/laz/layered_items.h"

#include <array>
#include <cstring>
#include <utility>

#include "io/laz/colour_decoder.h"

namespace gaussmap::detail {

namespace {

/// The state of an item for each scanner channel. `State` has a member `last`, the item of the last point, and a
/// function reset().
///
/// Version 3 of the items has two oddities, which files depend on. A point whose channel is that of the point before
/// counts as channel 0. And the first point after a change of the channel follows the last point of the channel before,
/// and replaces it. Version 4 does what one expects.
template <typename State>
class ChannelStates {
 public:
  template <typename... Arguments>
  explicit ChannelStates(bool has_oddities, const Arguments&... arguments) : has_oddities_(has_oddities) {
    states_.reserve(kScannerChannels);
    for (unsigned i = 0; i < kScannerChannels; ++i) states_.emplace_back(arguments...);
  }

  template <typename Last>
  void start(const Last& first, unsigned channel) {
    is_used_ = {};
    use(channel, first);
    current_ = channel;
  }

  struct Selected {
    State& models;
    State& owner;  // of the last item
  };
  Selected select(const PointChannel& point) {
    const unsigned channel = has_oddities_ && !point.is_new ? 0 : point.channel;
    const unsigned before = std::exchange(current_, channel);
    if (channel == before) return {states_[channel], states_[channel]};
    const bool was_used = is_used_[channel];
    if (!was_used) use(channel, states_[before].last);
    return {states_[channel], states_[was_used && has_oddities_ ? before : channel]};
  }

 private:
  template <typename Last>
  void use(unsigned channel, const Last& last) {
    is_used_[channel] = true;
    states_[channel].last = last;
    states_[channel].reset();
  }

  bool has_oddities_;
  std::vector<State> states_;
  std::array<bool, kScannerChannels> is_used_{};
  unsigned current_ = 0;
};

/// RGB14, and RGBNIR14 with near infrared.
class LayeredColours : public LayeredItem {
 public:
  explicit LayeredColours(const LazItem& item)
      : has_infrared_(item.type == LazItemType::RgbNir14), states_(item.version < 4) {}

  std::vector<unsigned> layers() const override {
    return has_infrared_ ? std::vector<unsigned>{kLazColour, kLazInfrared} : std::vector<unsigned>{kLazColour};
  }
  void start(const char* first, unsigned channel) override {
    Last last;
    std::memcpy(last.colour.data(), first, kColourSize);
    if (has_infrared_) std::memcpy(&last.infrared, first + kColourSize, sizeof last.infrared);
    states_.start(last, channel);
  }
  void decode(LazLayer* layers, PointChannel& channel, char* record) override {
    const auto selected = states_.select(channel);
    Last& last = selected.owner.last;
    if (layers[0].changes()) selected.models.colours.next(layers[0].coder(), last.colour);
    std::memcpy(record, last.colour.data(), kColourSize);
    if (!has_infrared_) return;
    if (layers[1].changes()) selected.models.infrared.next(layers[1].coder(), last.infrared);
    std::memcpy(record + kColourSize, &last.infrared, sizeof last.infrared);
  }

 private:
  static constexpr std::size_t kColourSize = 6;
  struct Last {
    ColourDecoder::Colour colour{};
    std::uint16_t infrared = 0;
  };
  struct State {
    Last last;
    ColourDecoder colours;
    ChannelDecoder infrared;
    void reset() {
      colours.reset();
      infrared.reset();
    }
  };

  bool has_infrared_;
  ChannelStates<State> states_;
};

/// Extra bytes, with a layer for each.
class LayeredBytes : public LayeredItem {
 public:
  explicit LayeredBytes(const LazItem& item) : size_(item.size), states_(item.version < 4, item.size) {}

  std::vector<unsigned> layers() const override { return std::vector<unsigned>(size_, kLazExtraBytes); }
  void start(const char* first, unsigned channel) override {
    states_.start(std::vector<std::uint8_t>(first, first + size_), channel);
  }
  void decode(LazLayer* layers, PointChannel& channel, char* record) override {
    const auto selected = states_.select(channel);
    std::vector<std::uint8_t>& last = selected.owner.last;
    for (std::size_t i = 0; i < size_; ++i)
      if (layers[i].changes())
        last[i] = static_cast<std::uint8_t>(last[i] + layers[i].coder().symbol(selected.models.models[i]));
    std::memcpy(record, last.data(), size_);
  }

 private:
  struct State {
    explicit State(std::size_t size) : last(size) {
      models.reserve(size);
      for (std::size_t i = 0; i < size; ++i) models.emplace_back(256);
    }
    std::vector<std::uint8_t> last;
    std::vector<SymbolModel> models;
    void reset() {
      for (SymbolModel& model : models) model.reset();
    }
  };

  std::size_t size_;
  ChannelStates<State> states_;
};

}  // namespace

std::unique_ptr<LayeredItem> layeredItem(const LazItem& item) {
  if (item.type == LazItemType::Bytes14) return std::make_unique<LayeredBytes>(item);
  return std::make_unique<LayeredColours>(item);
}

}  // namespace gaussmap::detail
