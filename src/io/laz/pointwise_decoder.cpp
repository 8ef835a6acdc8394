// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "io/laz/chunk_decoder.h"
#include "io/laz/pointwise_items.h"

namespace gaussmap::detail {

namespace {

class PointwiseDecoder : public LazChunkDecoder {
 public:
  explicit PointwiseDecoder(const std::vector<LazItem>& items) {
    for (const LazItem& item : items) {
      parts_.push_back({item.version == 1 ? pointwiseItemV1(item) : pointwiseItemV2(item), record_size_});
      record_size_ += item.size;
    }
  }

  std::string start(std::string_view data, std::uint64_t /*points*/) override {
    if (data.size() < record_size_) return "ends before its first point";
    first_ = data.substr(0, record_size_);
    is_first_ = true;
    for (const Part& part : parts_) part.item->start(first_.data() + part.offset);
    coder_ = ArithmeticDecoder(data.substr(record_size_));
    return "";
  }

  std::string decode(std::size_t points, char* records) override {
    if (points > 0 && is_first_) {
      std::memcpy(records, first_.data(), record_size_);
      records += record_size_;
      --points;
      is_first_ = false;
    }
    for (std::size_t i = 0; i < points; ++i, records += record_size_)
      for (const Part& part : parts_) part.item->decode(coder_, records + part.offset);
    if (points == 0) return "";
    bool failed = coder_.failed();
    for (const Part& part : parts_) failed = failed || part.item->failed();
    return failed ? "ends too early or is damaged" : "";
  }

  std::size_t bytes() const override { return record_size_ + coder_.position(); }

 private:
  struct Part {
    std::unique_ptr<PointwiseItem> item;
    std::size_t offset = 0;  // in the record
  };
  std::vector<Part> parts_;
  std::size_t record_size_ = 0;
  std::string_view first_;
  bool is_first_ = false;
  ArithmeticDecoder coder_;
};

}  // namespace

std::unique_ptr<LazChunkDecoder> pointwiseDecoder(const std::vector<LazItem>& items) {
  return std::make_unique<PointwiseDecoder>(items);
}

}  // namespace gaussmap::detail
