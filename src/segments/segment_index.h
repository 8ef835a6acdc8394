// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// The polygon that contains the observations of a segment: a rectangle around its middle line.
struct Strip {
  Vector<2> start{0.0, 0.0};      ///< start of the middle line [m]
  Vector<2> direction{1.0, 0.0};  ///< unit vector along the middle line
  double length = 0.0;            ///< [m]
  double half_width = 0.0;        ///< [m]

  bool contains(const Vector<2>& point) const;
  /// Returns the strip extended by `by` [m] on every side.
  Strip grown(double by) const;
};

/// Finds the strips that contain a point, by means of a square lattice.
class SegmentIndex {
 public:
  explicit SegmentIndex(double cell = 0.5) : cell_(cell) {}
  /// Sets the strip of number `id`. This is fast if the new strip lies within the area that is already entered for it.
  void update(int id, const Strip& strip);
  void erase(int id);
  /// Returns all numbers whose strip contains the point, and some others near it.
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
