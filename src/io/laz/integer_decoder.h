// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "io/laz/arithmetic_decoder.h"

namespace gaussmap::detail {

/// Decodes integers that are stored as differences from a prediction.
///
/// A difference is stored in two steps: the number k of its bits, with a model per context, and then the bits. The
/// upper 8 bits have a model per k, and the bits below them are stored without a model.
class IntegerDecoder {
 public:
  /// `bits`: size of the integers, up to 32. A context is a situation with its own statistics.
  explicit IntegerDecoder(unsigned bits, unsigned contexts = 1);
  /// Forgets all statistics.
  void reset();

  /// Returns the next integer modulo 2^32. Its lowest `bits` bits are valid. Negative predictions are given modulo
  /// 2^32.
  std::uint32_t decode(ArithmeticDecoder& coder, std::uint32_t prediction, unsigned context = 0) {
    bits_ = coder.symbol(sizes_[context]);
    return prediction + difference(coder);
  }
  /// Like decode(), for signed integers.
  std::int32_t decodeSigned(ArithmeticDecoder& coder, std::int32_t prediction, unsigned context = 0) {
    return static_cast<std::int32_t>(decode(coder, static_cast<std::uint32_t>(prediction), context));
  }
  /// Returns the number of bits of the last difference, which predicts the size of related differences.
  unsigned lastBits() const { return bits_; }

 private:
  std::uint32_t difference(ArithmeticDecoder& coder);

  unsigned bits_ = 0;
  std::vector<SymbolModel> sizes_;
  BitModel zero_or_one_;
  std::vector<SymbolModel> upper_bits_;  // upper_bits_[k]
};

}  // namespace gaussmap::detail
