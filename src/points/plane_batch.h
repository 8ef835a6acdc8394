// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace gaussmap::detail {

/// Ranges of points that one plane goes through.
class PlaneRanges {
 public:
  static constexpr std::size_t kCapacity = 81;

  std::size_t size() const { return size_; }
  std::uint32_t first(std::size_t i) const { return first_[i + 1]; }
  std::uint32_t last(std::size_t i) const { return last_[i + 1]; }
  void clear() {
    end_ = 0xFFFFFFFFu;
    size_ = 0;
  }

  /// Adds some. While it lives, what a next range depends on stays in registers: the ranges know of what was added once
  /// it is gone. One at a time.
  class Adder {
   public:
    explicit Adder(PlaneRanges& ranges)
        : ranges_(ranges), start_(ranges.start_), end_(ranges.end_), size_(ranges.size_) {}
    Adder(const Adder&) = delete;
    Adder& operator=(const Adder&) = delete;
    ~Adder() {
      ranges_.start_ = start_;
      ranges_.end_ = end_;
      ranges_.size_ = size_;
    }
    /// Joins it to the one before if it follows that: without a branch, which would be guessed wrongly too often.
    /// Returns its size.
    std::uint32_t add(std::uint32_t from, std::uint32_t to) {
      const bool is_joined = from == end_;
      start_ = is_joined ? start_ : from;
      end_ = to;
      size_ += !is_joined;
      ranges_.first_[size_] = start_;
      ranges_.last_[size_] = end_;
      return to - from;
    }

   private:
    PlaneRanges& ranges_;
    std::uint32_t start_, end_;
    std::size_t size_;
  };

 private:
  std::array<std::uint32_t, kCapacity + 1> first_, last_;  // from the second entry on
  std::uint32_t start_ = 0, end_ = 0xFFFFFFFFu;            // of the last range
  std::size_t size_ = 0;
};

/// Sums over points, about one of them: x times x y z 1, y times the same, z times the same, and their number.
struct PlaneSums {
  std::array<double, 12> product{};
  double count = 0.0;
  static constexpr std::size_t kPadding = 8;
};

/// `points`: x y z 1 each, and kPadding more that are not counted. At least one range, none empty.
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

}  // namespace gaussmap::detail
