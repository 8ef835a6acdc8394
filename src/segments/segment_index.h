// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// The polygon whose points belong to a segment: a rectangle about its middle line.
struct Strip {
  Vector<2> start{0.0, 0.0};      ///< ends of the middle line [m]
  Vector<2> direction{1.0, 0.0};  ///< unit vector from start on
  double length = 0.0;            ///< [m]
  double half_width = 0.0;        ///< [m]

  bool contains(const Vector<2>& point) const;
  /// Longer and wider by `by` all around.
  Strip grown(double by) const;
};

/// Finds the strips that a point lies in, by the cells of a square lattice.
class SegmentIndex {
 public:
  explicit SegmentIndex(double cell = 0.5) : cell_(cell) {}
  /// Number `id` now has this strip. Cheap while it stays within what is already entered.
  void update(int id, const Strip& strip);
  void erase(int id);
  /// Numbers whose strip may contain the point, and all whose strip does.
  const std::vector<int>& near(const Vector<2>& point) const;
  std::size_t bytes() const;

 private:
  struct Entered {
    bool in_use = false;
    Strip strip;
    std::vector<std::uint64_t> keys;
  };
  std::uint64_t key(std::int64_t column, std::int64_t row) const;
  std::int64_t lattice(double coordinate) const;

  double cell_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
  std::vector<Entered> entered_;
  std::vector<int> none_;
};

}  // namespace gaussmap::detail
