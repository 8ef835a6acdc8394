// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>

#include "gaussmap/core/cell_moments.h"

namespace gaussmap::detail {

/// Points are rounded to a lattice with 2^16 steps per finest cell. After that, cells and offsets are integers. The
/// rounding is one multiplication and one addition, each rounded separately. The files that include this header are
/// compiled with -ffp-contract=off. Every instruction set therefore gives the same lattice point.

inline double stepsPerMetre(double resolution) {
  return static_cast<double>(kStepsPerCell) / resolution;
}

/// Adding 1.5 * 2^52 to |steps| < 2^51 leaves the nearest integer (ties to even) in the low bits of the double.
inline constexpr double kSnap = 0x1.8p52;
inline constexpr std::int64_t kSnapBits = 0x4338000000000000;

/// Returns the lattice coordinate from the bits of (steps + kSnap). The result is meaningless if |steps| is not a
/// number below 2^51; misfitsLattice() detects this.
inline std::int64_t latticeFromBits(std::int64_t bits) {
  return bits - kSnapBits;
}

/// Returns 0 if the coordinate lies in a cell with a 32-bit index. Otherwise, also for the results of NaN and infinity,
/// the value is not 0.
inline std::uint64_t misfitsLattice(std::int64_t lattice) {
  return (static_cast<std::uint64_t>(lattice) + (std::uint64_t{1} << 47)) >> 48;
}

inline std::int32_t cellOfLattice(std::int64_t lattice) {
  return static_cast<std::int32_t>(static_cast<std::uint64_t>(lattice) >> 16);
}

/// Returns the offset from the centre of the cell [steps].
inline std::int32_t offsetOfLattice(std::int64_t lattice) {
  return static_cast<std::int32_t>(lattice & (kStepsPerCell - 1)) - static_cast<std::int32_t>(kStepsPerCell / 2);
}

inline std::int64_t snap(double steps) {
  const double shifted = steps + kSnap;
  std::int64_t bits = 0;
  std::memcpy(&bits, &shifted, sizeof bits);
  return latticeFromBits(bits);
}

/// Throws std::out_of_range. The message gives the point, the resolution and what to do.
[[noreturn]] void throwOutsideLattice(const double* point, int dimension, double resolution);

}  // namespace gaussmap::detail
