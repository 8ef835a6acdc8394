// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace gaussmap::detail {

/// An adaptive probability model of an alphabet with up to 1024 symbols, for ArithmeticDecoder.
///
/// The probabilities follow the symbols that were decoded. All values must be those of the encoder, so the arithmetic
/// in this class is part of the file format. The tables are allocated at the first symbol, because most models of a
/// file are never used.
class SymbolModel {
 public:
  explicit SymbolModel(unsigned symbols) : symbols_(symbols) {}
  /// Makes all symbols equally likely.
  void reset() { until_update_ = 0; }

 private:
  friend class ArithmeticDecoder;
  void start();
  void update();

  std::uint16_t* cumulative() const { return cells_.get(); }
  std::uint16_t* counts() const { return cells_.get() + symbols_ + 1; }
  std::uint16_t* firsts() const { return cells_.get() + 2 * symbols_ + 1; }

  unsigned symbols_;
  unsigned total_ = 0;         // sum of the counts at the last update
  unsigned cycle_ = 0;         // symbols from one update to the next
  unsigned until_update_ = 0;  // symbols to the next update; 0: not started
  unsigned shift_ = 0;         // probability to bucket of firsts(); 0: the alphabet is small and has no buckets
  // The cumulative probabilities in units of 2^-15 and a sentinel, the counts, and for each bucket of probabilities
  // the symbol at its start.
  std::unique_ptr<std::uint16_t[]> cells_;
};

/// Like SymbolModel, for an alphabet of two symbols.
class BitModel {
 public:
  /// Makes both symbols equally likely.
  void reset() { *this = BitModel(); }

 private:
  friend class ArithmeticDecoder;
  void update();

  std::uint32_t probability_ = 1u << 12;  // of 0, in units of 2^-13
  std::uint32_t zeros_ = 1;
  std::uint32_t total_ = 2;
  std::uint32_t cycle_ = 4;
  std::uint32_t until_update_ = 4;
};

/// Decodes symbols of an arithmetic coder with 32-bit registers, as used by LASzip.
///
/// Reads nothing outside the data: behind their end, the decoder reads zeros, and failed() returns true. So callers can
/// check failed() once per group of points.
class ArithmeticDecoder {
 public:
  ArithmeticDecoder() = default;
  /// Starts decoding. The first four bytes fill the register.
  explicit ArithmeticDecoder(std::string_view data);

  /// Returns true if the data were too short or are impossible.
  bool failed() const { return failed_; }
  /// Returns the number of bytes read.
  std::size_t position() const { return static_cast<std::size_t>(place_ - begin_); }

  /// Decodes a symbol and adapts the model.
  unsigned symbol(SymbolModel& model);
  /// Decodes a bit and adapts the model.
  unsigned bit(BitModel& model);
  /// Decodes bits without a model. `count` must be from 1 to 32.
  std::uint32_t bits(unsigned count);

 private:
  static constexpr std::uint32_t kMinLength = 1u << 24;

  void refill() {
    do {
      value_ = value_ << 8 | next();
      length_ <<= 8;
    } while (length_ < kMinLength);
  }
  std::uint32_t next() {
    if (place_ != end_) return static_cast<unsigned char>(*place_++);
    failed_ = true;
    return 0;
  }
  std::uint32_t fewBits(unsigned count);

  // value_ < length_ always holds, so that value_ / (length_ >> 15) is less than 2^15 + 64.
  std::uint32_t value_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFu;
  const char* begin_ = nullptr;
  const char* place_ = nullptr;
  const char* end_ = nullptr;
  bool failed_ = false;
};

inline unsigned ArithmeticDecoder::symbol(SymbolModel& model) {
  if (model.until_update_ == 0) model.start();
  const std::uint16_t* const cumulative = model.cumulative();
  const std::uint32_t unit = length_ >> 15;
  unsigned symbol = 0;
  if (model.shift_ != 0) {
    const std::uint32_t probability = value_ / unit;
    symbol = model.firsts()[probability >> model.shift_];
    while (cumulative[symbol + 1] <= probability) ++symbol;
  } else {
    while (symbol + 1 < model.symbols_ && cumulative[symbol + 1] * unit <= value_) ++symbol;
  }
  const std::uint32_t low = cumulative[symbol] * unit;
  value_ -= low;
  length_ = (symbol + 1 < model.symbols_ ? cumulative[symbol + 1] * unit : length_) - low;
  if (length_ < kMinLength) refill();
  ++model.counts()[symbol];
  if (--model.until_update_ == 0) model.update();
  return symbol;
}

inline unsigned ArithmeticDecoder::bit(BitModel& model) {
  const std::uint32_t zero = model.probability_ * (length_ >> 13);
  const bool bit = value_ >= zero;
  if (bit) {
    value_ -= zero;
    length_ -= zero;
  } else {
    length_ = zero;
    ++model.zeros_;
  }
  if (length_ < kMinLength) refill();
  if (--model.until_update_ == 0) model.update();
  return bit ? 1 : 0;
}

}  // namespace gaussmap::detail
