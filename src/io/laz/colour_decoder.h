// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "io/laz/arithmetic_decoder.h"

namespace gaussmap::detail {

/// Decodes colours of three 16-bit channels as differences from the last colour. The bytes of the channels are stored
/// separately. Green and blue are predicted from the change of the channels before them.
class ColourDecoder {
 public:
  using Colour = std::array<std::uint16_t, 3>;

  void reset();
  /// Replaces the last colour by the next one.
  void next(ArithmeticDecoder& coder, Colour& colour);

 private:
  SymbolModel changes_{128};
  std::array<SymbolModel, 6> bytes_{SymbolModel(256), SymbolModel(256), SymbolModel(256),
                                    SymbolModel(256), SymbolModel(256), SymbolModel(256)};
};

/// Decodes one 16-bit channel in the same way, for near infrared.
class ChannelDecoder {
 public:
  void reset();
  void next(ArithmeticDecoder& coder, std::uint16_t& value);

 private:
  SymbolModel changes_{4};
  std::array<SymbolModel, 2> bytes_{SymbolModel(256), SymbolModel(256)};
};

}  // namespace gaussmap::detail
