// SPDX-License-Identifier: BSD-3-Clause
#include "io/laz/integer_decoder.h"

#include <algorithm>

namespace gaussmap::detail {

namespace {
constexpr unsigned kUpperBits = 8;  // bits with a model
}

IntegerDecoder::IntegerDecoder(unsigned bits, unsigned contexts) {
  sizes_.reserve(contexts);
  for (unsigned i = 0; i < contexts; ++i) sizes_.emplace_back(bits + 1);
  upper_bits_.reserve(bits + 1);
  for (unsigned k = 0; k <= bits; ++k) upper_bits_.emplace_back(1u << std::min(k, kUpperBits));
}

void IntegerDecoder::reset() {
  bits_ = 0;
  for (SymbolModel& model : sizes_) model.reset();
  zero_or_one_.reset();
  for (SymbolModel& model : upper_bits_) model.reset();
}

// Differences with k bits are -(2^k - 1) .. -2^(k-1) and 2^(k-1) + 1 .. 2^k, stored from 0 to 2^k - 1 in this order.
std::uint32_t IntegerDecoder::difference(ArithmeticDecoder& coder) {
  const unsigned k = bits_;
  if (k == 0) return coder.bit(zero_or_one_);
  if (k == 32) return 0x80000000u;
  std::uint32_t rank = coder.symbol(upper_bits_[k]);
  if (k > kUpperBits) rank = rank << (k - kUpperBits) | coder.bits(k - kUpperBits);
  return rank >> (k - 1) != 0 ? rank + 1 : rank - ((1u << k) - 1);
}

}  // namespace gaussmap::detail
