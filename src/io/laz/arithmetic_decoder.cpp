// SPDX-License-Identifier: BSD-3-Clause
#include "io/laz/arithmetic_decoder.h"

#include <algorithm>

namespace gaussmap::detail {

namespace {

constexpr unsigned kMaxSymbolTotal = 1u << 15;
constexpr std::uint32_t kMaxBitTotal = 1u << 13;
constexpr unsigned kSmallAlphabet = 16;  // up to this size, a search from the start is fastest

/// Returns the shift that makes about one bucket of two symbols. It is at least 6, so that every quotient that
/// ArithmeticDecoder::symbol() computes has a bucket.
unsigned bucketShift(unsigned symbols) {
  unsigned bits = 4;
  while ((2u << bits) < symbols) ++bits;
  return 15 - bits;
}

}  // namespace

void SymbolModel::start() {
  if (!cells_) {
    shift_ = symbols_ > kSmallAlphabet ? bucketShift(symbols_) : 0;
    const std::size_t buckets = shift_ > 0 ? (std::size_t{1} << (15 - shift_)) + 1 : 0;
    cells_ = std::make_unique<std::uint16_t[]>(2 * symbols_ + 1 + buckets);
    cumulative()[symbols_] = 0xFFFF;
  }
  std::fill_n(counts(), symbols_, std::uint16_t{1});
  total_ = 0;
  cycle_ = symbols_;
  update();
  cycle_ = (symbols_ + 6) / 2;
  until_update_ = cycle_;
}

void SymbolModel::update() {
  std::uint16_t* const counts = this->counts();
  total_ += cycle_;
  if (total_ > kMaxSymbolTotal) {
    total_ = 0;
    for (unsigned s = 0; s < symbols_; ++s) {
      counts[s] = static_cast<std::uint16_t>((counts[s] + 1u) / 2);
      total_ += counts[s];
    }
  }

  std::uint16_t* const cumulative = this->cumulative();
  // Every count is at least 1.
  // cppcheck-suppress zerodiv
  const std::uint32_t scale = 0x80000000u / total_;
  std::uint32_t sum = 0;
  for (unsigned s = 0; s < symbols_; ++s) {
    cumulative[s] = static_cast<std::uint16_t>(scale * sum >> 16);
    sum += counts[s];
  }
  if (shift_ > 0) {
    std::uint16_t* const firsts = this->firsts();
    const unsigned buckets = (1u << (15 - shift_)) + 1;
    unsigned symbol = 0;
    for (unsigned bucket = 0; bucket < buckets; ++bucket) {
      while (cumulative[symbol + 1] <= bucket << shift_) ++symbol;
      firsts[bucket] = static_cast<std::uint16_t>(symbol);
    }
  }

  cycle_ = std::min(cycle_ * 5 / 4, (symbols_ + 6) * 8);
  until_update_ = cycle_;
}

void BitModel::update() {
  total_ += cycle_;
  if (total_ > kMaxBitTotal) {
    total_ = (total_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == total_) ++total_;
  }
  probability_ = zeros_ * (0x80000000u / total_) >> 18;
  cycle_ = std::min(cycle_ * 5 / 4, std::uint32_t{64});
  until_update_ = cycle_;
}

ArithmeticDecoder::ArithmeticDecoder(std::string_view data)
    : begin_(data.data()), place_(begin_), end_(begin_ + data.size()) {
  for (int i = 0; i < 4; ++i) value_ = value_ << 8 | next();
  if (value_ == length_) {  // no encoder writes this
    value_ = 0;
    failed_ = true;
  }
}

std::uint32_t ArithmeticDecoder::bits(unsigned count) {
  if (count < 20) return fewBits(count);
  const std::uint32_t low = fewBits(16);
  return fewBits(count - 16) << 16 | low;
}

std::uint32_t ArithmeticDecoder::fewBits(unsigned count) {
  const std::uint32_t unit = length_ >> count;
  const std::uint32_t bits = value_ / unit;
  value_ -= bits * unit;
  length_ = unit;
  if (length_ < kMinLength) refill();
  if (bits >> count == 0) return bits;
  failed_ = true;  // in the part of the range that the encoder does not use
  return bits & ((1u << count) - 1);
}

}  // namespace gaussmap::detail
