// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "io/laz/arithmetic_decoder.h"

namespace gaussmap::detail {

/// Decodes a byte of each point with a model that depends on this byte of the point before.
class ByteAfterByte {
 public:
  ByteAfterByte() {
    models_.reserve(256);
    for (int i = 0; i < 256; ++i) models_.emplace_back(256);
  }
  void reset() {
    for (SymbolModel& model : models_) model.reset();
  }
  void next(ArithmeticDecoder& coder, std::uint8_t& byte) {
    byte = static_cast<std::uint8_t>(coder.symbol(models_[byte]));
  }

 private:
  std::vector<SymbolModel> models_;
};

}  // namespace gaussmap::detail
