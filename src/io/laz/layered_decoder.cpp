// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>

#include "io/laz/chunk_decoder.h"
#include "io/laz/layered_items.h"

namespace gaussmap::detail {

namespace {

std::uint32_t numberAt(std::string_view data, std::size_t place) {
  std::uint32_t number = 0;
  std::memcpy(&number, data.data() + place, sizeof number);
  return number;
}

/// A chunk has the first point, the number of points, the sizes of the layers, and the layers.
class LayeredDecoder : public LazChunkDecoder {
 public:
  LayeredDecoder(const std::vector<LazItem>& items, unsigned wanted) {
    for (const LazItem& item : items) {
      parts_.push_back({parts_.empty() ? layeredPoint() : layeredItem(item), record_size_, layer_flags_.size()});
      const std::vector<unsigned> flags = parts_.back().item->layers();
      for (const unsigned flag : flags) layer_flags_.push_back(flag & (wanted | 1u));
      record_size_ += item.size;
    }
    layers_.resize(layer_flags_.size());
  }

  std::string start(std::string_view data, std::uint64_t points) override {
    const std::size_t header = record_size_ + sizeof(std::uint32_t) * (1 + layers_.size());
    if (data.size() < header) return "ends before its layers";
    first_ = data.substr(0, record_size_);
    is_first_ = true;
    if (const std::uint32_t count = numberAt(data, record_size_); count != points)
      return "has " + std::to_string(count) + " points, but " + std::to_string(points) + " were expected";
    bytes_ = header;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const std::size_t size = numberAt(data, record_size_ + sizeof(std::uint32_t) * (i + 1));
      if (size > data.size() - bytes_)
        return "has a layer of " + std::to_string(size) + " bytes, but only " + std::to_string(data.size() - bytes_) +
               " bytes follow";
      layers_[i].start(layer_flags_[i] != 0 ? data.substr(bytes_, size) : std::string_view());
      bytes_ += size;
    }
    const unsigned channel = static_cast<unsigned char>(first_[kFlags]) >> 4 & (kScannerChannels - 1);
    for (const Part& part : parts_) part.item->start(first_.data() + part.offset, channel);
    if (points > 1 && !layers_[0].changes()) return "has no coordinates";
    return "";
  }

  std::string decode(std::size_t points, char* records) override {
    if (points > 0 && is_first_) {
      std::memcpy(records, first_.data(), record_size_);
      records += record_size_;
      --points;
      is_first_ = false;
    }
    for (std::size_t i = 0; i < points; ++i, records += record_size_) {
      PointChannel channel;
      for (const Part& part : parts_) part.item->decode(&layers_[part.first_layer], channel, records + part.offset);
    }
    if (points == 0) return "";
    const bool failed =
        std::any_of(layers_.begin(), layers_.end(), [](const LazLayer& layer) { return layer.failed(); }) ||
        std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.item->failed(); });
    return failed ? "ends too early or is damaged" : "";
  }

  std::size_t bytes() const override { return bytes_; }

 private:
  static constexpr std::size_t kFlags = 15;  // byte of the record with the scanner channel
  struct Part {
    std::unique_ptr<LayeredItem> item;
    std::size_t offset = 0;  // in the record
    std::size_t first_layer = 0;
  };
  std::vector<Part> parts_;
  std::vector<unsigned> layer_flags_;
  std::vector<LazLayer> layers_;
  std::size_t record_size_ = 0;
  std::string_view first_;
  bool is_first_ = false;
  std::size_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<LazChunkDecoder> layeredDecoder(const std::vector<LazItem>& items, unsigned wanted) {
  return std::make_unique<LayeredDecoder>(items, wanted);
}

}  // namespace gaussmap::detail
