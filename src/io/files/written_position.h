// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "gaussmap/version.h"

// Positions that lost digits when they were written as text, for example by `std::ostream << x` or "%g".
namespace gaussmap::detail {

/// Returns the step of the last written digit [m] if the words of a position look rounded: all have at most 7
/// significant digits, and one of more than 1000 m has 6 or 7 and a step of more than 1 cm. Returns 0 for others.
GAUSSMAP_API double stepOfRoundedPosition(const std::array<std::string_view, 3>& words);

/// Counts the rounded positions of several scans.
class GAUSSMAP_API RoundedPositions {
 public:
  /// Adds a position [m] and its step, see stepOfRoundedPosition().
  void add(double step, double x, double y, double z);
  /// Returns a warning without the name of the file; empty if fewer than two positions, or less than half, are rounded.
  std::string warning() const;

 private:
  std::size_t count_ = 0, rounded_ = 0;
  double step_ = 0.0, largest_ = 0.0;
};

}  // namespace gaussmap::detail
