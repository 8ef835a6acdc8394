// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace gaussmap {

/// Ranges of points that one plane goes through.
struct PlaneRanges {
  static constexpr std::size_t kCapacity = 81;
  std::array<std::uint32_t, kCapacity> first, last;
  std::size_t size = 0;

  /// Joins it to the one before if it follows that.
  void add(std::uint32_t from, std::uint32_t to) {
    if (size > 0 && last[size - 1] == from) {
      last[size - 1] = to;
      return;
    }
    first[size] = from;
    last[size++] = to;
  }
};

/// Sums over points, about one of them: x times x y z 1, y times the same, z times the same, and their number.
struct PlaneSums {
  std::array<double, 12> product{};
  double count = 0.0;
};

/// `points`: x y z 1 each. At least one range, none empty.
PlaneSums sumUp(const std::array<float, 4>* points, const PlaneRanges& ranges);

/// Planes through many sets of points at once, in vector registers.
struct PlaneBatch {
  static constexpr std::size_t kCapacity = 64;
  alignas(64) double products[12][kCapacity] = {}, counts[kCapacity] = {};
  alignas(64) double normal[3][kCapacity], curvature[kCapacity];  ///< NaN where points span no plane

  void set(std::size_t i, const PlaneSums& points) {
    for (std::size_t row = 0; row < 12; ++row) products[row][i] = points.product[row];
    counts[i] = points.count;
  }
  /// `rounding`: variances below it are none [m^2].
  void solve(double rounding);
};

}  // namespace gaussmap
