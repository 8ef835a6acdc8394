// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <cmath>
#include <cstdint>

namespace gaussmap {

/// A small seeded generator (SplitMix64) that gives the same numbers with every standard library: the
/// distributions of <random> do not. Cheap to make, so that each cell or cluster can have its own.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// A generator for one part of a job: independent of all other parts, whatever the order they run in.
  static Random forPart(std::uint64_t seed, std::uint64_t part) {
    Random mixed(seed ^ (part * 0x9E3779B97F4A7C15ull));
    return Random(mixed.bits() + part);
  }

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

  /// Uniform in {0, ..., n - 1}; n > 0. The bias of the multiplication is below n / 2^64.
  std::uint64_t below(std::uint64_t n) {
    const std::uint64_t high = bits() >> 32, low = bits() >> 32;
    return ((high * n) + ((low * n) >> 32)) >> 32;
  }

  /// Standard normal (Marsaglia's polar method).
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double u = 0.0, v = 0.0, square = 0.0;
    do {
      u = 2.0 * uniform() - 1.0;
      v = 2.0 * uniform() - 1.0;
      square = u * u + v * v;
    } while (square >= 1.0 || square == 0.0);
    const double factor = std::sqrt(-2.0 * std::log(square) / square);
    spare_ = v * factor;
    has_spare_ = true;
    return u * factor;
  }

 private:
  std::uint64_t state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace gaussmap
