// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "io/laz/arithmetic_decoder.h"
#include "io/laz/integer_decoder.h"

namespace gaussmap::detail {

/// Decodes the GPS times of points. The 64 bits of a double are treated as an integer.
///
/// The times are predicted by up to four sequences with constant steps, because merged flight lines alternate. A step
/// is stored as a multiple of the last step of its sequence and a difference.
class GpsTimeDecoder {
 public:
  /// `can_repeat`: a symbol for an unchanged time exists. Layered files store that elsewhere.
  explicit GpsTimeDecoder(bool can_repeat);
  /// Forgets everything. `time`: the bits of the first time.
  void start(std::uint64_t time);
  /// Returns the bits of the next time. A failure shows in coder.failed() or in failed().
  std::uint64_t next(ArithmeticDecoder& coder);
  /// Returns true if the data are not valid.
  bool failed() const { return failed_; }

 private:
  struct Sequence {
    std::uint64_t time = 0;
    std::int32_t step = 0;
    int extremes = 0;  // steps since the last usual one
  };
  /// Returns false if the symbol only selected another sequence.
  bool nextAfterStep(ArithmeticDecoder& coder, Sequence& sequence);
  bool nextWithoutStep(ArithmeticDecoder& coder, Sequence& sequence);
  void startSequence(ArithmeticDecoder& coder);
  void addStep(Sequence& sequence, std::int32_t step, bool is_extreme);

  bool can_repeat_;
  bool failed_ = false;
  std::array<Sequence, 4> sequences_{};
  unsigned current_ = 0;
  unsigned newest_ = 0;
  SymbolModel multiples_;
  SymbolModel first_steps_;
  IntegerDecoder integers_;
};

}  // namespace gaussmap::detail
