// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>

#include "gaussmap/gaussian/cell_moments.h"

namespace gaussmap {

/// Points snap to a lattice with 2^16 steps per finest cell; from there on cells and offsets are integers.
/// The rounding is one multiplication and one addition, each rounded by itself: the files that include this
/// are compiled with -ffp-contract=off, so that no instruction set gives another lattice point.

/// Lattice coordinates below this fit a 32-bit cell index (with one cell to spare for the rounding).
inline constexpr double kLatticeLimit = 0x1.0p47 - 0x1.0p16;

inline double stepsPerMetre(double resolution) { return static_cast<double>(kStepsPerCell) / resolution; }

/// Nearest integer (ties to even) of |steps| < 2^51: adding 1.5 * 2^52 leaves it in the low bits.
inline std::int64_t snap(double steps) {
  constexpr double kMagic = 0x1.8p52;
  const double shifted = steps + kMagic;
  std::int64_t bits = 0, magic_bits = 0;
  std::memcpy(&bits, &shifted, sizeof bits);
  std::memcpy(&magic_bits, &kMagic, sizeof magic_bits);
  return bits - magic_bits;
}

/// Throws std::out_of_range that quotes the point and the way out.
[[noreturn]] void throwOutsideLattice(const double* point, int dimension, double resolution);

}  // namespace gaussmap
