// SPDX-License-Identifier: BSD-3-Clause
#include "io/laz/gps_time_decoder.h"

namespace gaussmap::detail {

namespace {

// Symbols of a sequence with a step: 0 is another step, 1 to 500 are multiples, 501 to 510 are -1 to -10.
constexpr unsigned kMaxMultiple = 500;
constexpr unsigned kMinMultiple = 510;
constexpr unsigned kRepeat = 511;
constexpr unsigned kNewSequence = 512;  // the symbols after it select another sequence
constexpr unsigned kMultipleSymbols = 516;
// Symbols of a sequence without a step: 0 repeats the time.
constexpr unsigned kFirstStep = 1;
constexpr unsigned kFarStep = 2;  // the symbols after it select another sequence
constexpr unsigned kFirstStepSymbols = 6;

// Contexts of the integers.
enum : unsigned { kFirst, kOnce, kFew, kMany, kMost, kBackward, kFarBackward, kOther, kUpperHalf, kContexts };

constexpr int kMaxExtremes = 3;  // after more steps outside the range of multiples, the step of the sequence changes

std::int32_t times(std::int32_t step, int factor) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(step) * static_cast<std::uint32_t>(factor));
}

}  // namespace

GpsTimeDecoder::GpsTimeDecoder(bool can_repeat)
    : can_repeat_(can_repeat),
      multiples_(can_repeat ? kMultipleSymbols : kMultipleSymbols - 1),
      first_steps_(can_repeat ? kFirstStepSymbols : kFirstStepSymbols - 1),
      integers_(32, kContexts) {}

void GpsTimeDecoder::start(std::uint64_t time) {
  failed_ = false;
  sequences_ = {};
  sequences_[0].time = time;
  current_ = 0;
  newest_ = 0;
  multiples_.reset();
  first_steps_.reset();
  integers_.reset();
}

std::uint64_t GpsTimeDecoder::next(ArithmeticDecoder& coder) {
  constexpr int kMaxSelections = 8;  // encoders select once
  for (int i = 0; i < kMaxSelections; ++i) {
    Sequence& sequence = sequences_[current_];
    if (sequence.step == 0 ? nextWithoutStep(coder, sequence) : nextAfterStep(coder, sequence))
      return sequences_[current_].time;
  }
  failed_ = true;
  return sequences_[current_].time;
}

bool GpsTimeDecoder::nextWithoutStep(ArithmeticDecoder& coder, Sequence& sequence) {
  const unsigned symbol = coder.symbol(first_steps_) + (can_repeat_ ? 0 : 1);
  if (symbol == kFirstStep) {
    sequence.step = integers_.decodeSigned(coder, 0, kFirst);
    addStep(sequence, sequence.step, false);
    sequence.extremes = 0;
  } else if (symbol == kFarStep) {
    startSequence(coder);
  } else if (symbol > kFarStep) {
    current_ = (current_ + symbol - kFarStep) % 4;
    return false;
  }
  return true;
}

bool GpsTimeDecoder::nextAfterStep(ArithmeticDecoder& coder, Sequence& sequence) {
  unsigned symbol = coder.symbol(multiples_);
  if (!can_repeat_ && symbol >= kRepeat) ++symbol;
  const auto step = [&](int factor, unsigned context) {
    return integers_.decodeSigned(coder, times(sequence.step, factor), context);
  };
  if (symbol == 0) {
    addStep(sequence, step(0, kOther), true);
  } else if (symbol == 1) {
    addStep(sequence, step(1, kOnce), false);
    sequence.extremes = 0;
  } else if (symbol < kMaxMultiple) {
    addStep(sequence, step(static_cast<int>(symbol), symbol < 10 ? kFew : kMany), false);
  } else if (symbol == kMaxMultiple) {
    addStep(sequence, step(static_cast<int>(symbol), kMost), true);
  } else if (symbol <= kMinMultiple) {
    const bool is_extreme = symbol == kMinMultiple;
    const int factor = static_cast<int>(kMaxMultiple) - static_cast<int>(symbol);
    addStep(sequence, step(factor, is_extreme ? kFarBackward : kBackward), is_extreme);
  } else if (symbol == kNewSequence) {
    startSequence(coder);
  } else if (symbol > kNewSequence) {
    current_ = (current_ + symbol - kNewSequence) % 4;
    return false;
  }
  return true;
}

void GpsTimeDecoder::startSequence(ArithmeticDecoder& coder) {
  const auto upper = static_cast<std::uint32_t>(sequences_[current_].time >> 32);
  newest_ = (newest_ + 1) % 4;
  current_ = newest_;
  const std::uint64_t high = integers_.decode(coder, upper, kUpperHalf);
  std::uint64_t low = coder.bits(16);
  low |= static_cast<std::uint64_t>(coder.bits(16)) << 16;
  sequences_[current_] = {high << 32 | low, 0, 0};
}

void GpsTimeDecoder::addStep(Sequence& sequence, std::int32_t step, bool is_extreme) {
  sequence.time += static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
  if (!is_extreme || ++sequence.extremes <= kMaxExtremes) return;
  sequence.step = step;
  sequence.extremes = 0;
}

}  // namespace gaussmap::detail
