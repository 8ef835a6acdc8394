// SPDX-License-Identifier: BSD-3-Clause
#include "io/laz/colour_decoder.h"

#include <algorithm>

namespace gaussmap::detail {

namespace {

constexpr unsigned kNotGrey = 1u << 6;  // bits 0 to 5: low and high byte of red, green and blue have changed

int byteOf(std::uint16_t value, unsigned shift) {
  return value >> shift & 0xFF;
}

void setByte(std::uint16_t& value, unsigned shift, unsigned byte) {
  value = static_cast<std::uint16_t>((value & ~(0xFFu << shift)) | (byte & 0xFF) << shift);
}

}  // namespace

void ColourDecoder::reset() {
  changes_.reset();
  for (SymbolModel& model : bytes_) model.reset();
}

void ColourDecoder::next(ArithmeticDecoder& coder, Colour& colour) {
  const unsigned changes = coder.symbol(changes_);
  const Colour last = colour;
  const auto decode = [&](unsigned channel, unsigned high, int predicted) {
    const unsigned index = 2 * channel + high;
    if ((changes >> index & 1) == 0) return;
    const auto prediction = static_cast<unsigned>(std::clamp(predicted, 0, 255));
    setByte(colour[channel], 8 * high, prediction + coder.symbol(bytes_[index]));
  };
  for (unsigned high = 0; high < 2; ++high) decode(0, high, byteOf(last[0], 8 * high));
  if ((changes & kNotGrey) == 0) {
    colour[1] = colour[2] = colour[0];
    return;
  }
  for (unsigned high = 0; high < 2; ++high) {
    const unsigned shift = 8 * high;
    const int red = byteOf(colour[0], shift) - byteOf(last[0], shift);
    decode(1, high, byteOf(last[1], shift) + red);
    const int green = byteOf(colour[1], shift) - byteOf(last[1], shift);
    decode(2, high, byteOf(last[2], shift) + (red + green) / 2);
  }
}

void ChannelDecoder::reset() {
  changes_.reset();
  for (SymbolModel& model : bytes_) model.reset();
}

void ChannelDecoder::next(ArithmeticDecoder& coder, std::uint16_t& value) {
  const unsigned changes = coder.symbol(changes_);
  for (unsigned high = 0; high < 2; ++high)
    if ((changes >> high & 1) != 0)
      setByte(value, 8 * high, static_cast<unsigned>(byteOf(value, 8 * high)) + coder.symbol(bytes_[high]));
}

}  // namespace gaussmap::detail
